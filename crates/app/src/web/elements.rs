//! Elements of the page that stand for the window's controls: screen readers read, press and set them by name.

use egui::accesskit::{Action, ActionData, ActionRequest, Node, NodeId, Role, Toggled, TreeId, TreeUpdate};
use egui::{Context, Event, FullOutput, Plugin, RawInput};
use send_wrapper::SendWrapper;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::time::Duration;
use wasm_bindgen::prelude::*;
use web_sys::{Document, HtmlElement, HtmlInputElement, KeyboardEvent};
use web_time::Instant;

/// Time between two updates of the elements.
const UPDATE: Duration = Duration::from_millis(250);
/// An element lies where its control is drawn, is not seen, and leaves the pointer to the canvas.
const STYLE: &str = "position:absolute;margin:0;border:0;padding:0;overflow:hidden;opacity:0;pointer-events:none;";

/// The plugin that keeps the elements. A browser has one thread, which alone touches them.
pub(super) struct Elements(SendWrapper<Page>);

struct Page {
    document: Document,
    holder: HtmlElement,
    elements: HashMap<NodeId, Element>,
    /// What the elements ask of their controls.
    asked: Rc<RefCell<Vec<Asked>>>,
    /// The control that has the focus.
    focused: Option<NodeId>,
    updated: Option<Instant>,
}

/// What an element asks of its control.
type Asked = (NodeId, Action, Option<ActionData>);

struct Element {
    element: HtmlElement,
    role: &'static str,
    /// Its attributes as they stand.
    shown: Vec<(&'static str, String)>,
    _callbacks: Callbacks,
}

/// What is called when an element is pressed, set or focused, and when it has a key.
struct Callbacks {
    press: Closure<dyn FnMut()>,
    set: Closure<dyn FnMut()>,
    focus: Closure<dyn FnMut()>,
    key: Closure<dyn FnMut(KeyboardEvent)>,
}

impl Elements {
    /// Elements in the body of the page.
    ///
    /// # Errors
    /// Where there is no page.
    pub fn new() -> Result<Self, JsValue> {
        let document = web_sys::window().and_then(|window| window.document()).ok_or("there is no page")?;
        let holder: HtmlElement = document.create_element("div")?.dyn_into()?;
        holder.set_id("controls");
        document.body().ok_or("the page has no body")?.append_child(&holder)?;
        let page =
            Page { document, holder, elements: HashMap::new(), asked: Rc::default(), focused: None, updated: None };
        Ok(Self(SendWrapper::new(page)))
    }
}

impl Plugin for Elements {
    fn debug_name(&self) -> &'static str {
        "elements of the page"
    }

    fn setup(&mut self, context: &Context) {
        context.enable_accesskit();
    }

    fn input_hook(&mut self, _: &Context, input: &mut RawInput) {
        for (target_node, action, data) in self.0.asked.take() {
            let request = ActionRequest { action, target_tree: TreeId::ROOT, target_node, data };
            input.events.push(Event::AccessKitActionRequest(request));
        }
    }

    fn output_hook(&mut self, context: &Context, output: &mut FullOutput) {
        let due = self.0.updated.is_none_or(|updated| updated.elapsed() >= UPDATE);
        if let Some(update) = output.platform_output.accesskit_update.take().filter(|_| due) {
            self.0.updated = Some(Instant::now());
            // A page that takes no elements is drawn all the same.
            let _ = self.0.show(&update, context);
        }
    }
}

impl Page {
    fn show(&mut self, update: &TreeUpdate, context: &Context) -> Result<(), JsValue> {
        let named = update.nodes.iter().filter_map(|(id, node)| Some((*id, role(node)?, name(node)?, node)));
        let shown: HashMap<_, _> = named.map(|(id, role, name, node)| (id, (role, name, node))).collect();
        self.elements.retain(|id, element| {
            let stays = shown.get(id).is_some_and(|(role, ..)| *role == element.role);
            if !stays {
                element.element.remove();
            }
            stays
        });
        for (id, (role, name, node)) in shown {
            if !self.elements.contains_key(&id) {
                let element = self.element(id, role, context)?;
                self.elements.insert(id, element);
            }
            if let Some(element) = self.elements.get_mut(&id) {
                element.set(&attributes(role, name, node))?;
                element.show_value(node);
            }
        }
        self.show_focus(update.focus)
    }

    /// Tells a screen reader which control has the window's focus.
    fn show_focus(&mut self, focus: NodeId) -> Result<(), JsValue> {
        let focused = Some(focus).filter(|id| self.elements.contains_key(id));
        if focused == self.focused {
            return Ok(());
        }
        self.focused = focused;
        let Some(canvas) = self.document.get_element_by_id("window") else { return Ok(()) };
        match focused {
            Some(id) => canvas.set_attribute("aria-activedescendant", &html_id(id)),
            None => canvas.remove_attribute("aria-activedescendant"),
        }
    }

    /// An element of a role: an input where it has a value to be set.
    fn element(&self, id: NodeId, role: &'static str, context: &Context) -> Result<Element, JsValue> {
        let input = match role {
            "slider" => Some("range"),
            "spinbutton" => Some("number"),
            "textbox" => Some("text"),
            _ => None,
        };
        let element: HtmlElement = self.document.create_element(input.map_or("div", |_| "input"))?.dyn_into()?;
        element.set_id(&html_id(id));
        if let Some(kind) = input {
            element.set_attribute("type", kind)?;
            element.set_attribute("step", "any")?;
        }
        if !matches!(role, "img" | "note") {
            element.set_tab_index(0);
        }
        let callbacks = self.callbacks(id, &element, context);
        match input {
            Some("range") => element.set_oninput(Some(callbacks.set.as_ref().unchecked_ref())),
            // A number or a text counts once it is whole.
            Some(_) => element.set_onchange(Some(callbacks.set.as_ref().unchecked_ref())),
            None => element.set_onclick(Some(callbacks.press.as_ref().unchecked_ref())),
        }
        // A field of the window that has the focus would take the keys from its element.
        if !matches!(role, "spinbutton" | "textbox") {
            element.set_onfocus(Some(callbacks.focus.as_ref().unchecked_ref()));
        }
        element.set_onkeydown(Some(callbacks.key.as_ref().unchecked_ref()));
        self.holder.append_child(&element)?;
        Ok(Element { element, role, shown: Vec::new(), _callbacks: callbacks })
    }

    fn callbacks(&self, id: NodeId, element: &HtmlElement, context: &Context) -> Callbacks {
        let ask = {
            let (asked, context) = (self.asked.clone(), context.clone());
            move |action, data| {
                asked.borrow_mut().push((id, action, data));
                context.request_repaint();
            }
        };
        let press = {
            let ask = ask.clone();
            Closure::<dyn FnMut()>::new(move || ask(Action::Click, None))
        };
        let set = {
            let (ask, input) = (ask.clone(), element.clone().dyn_into::<HtmlInputElement>().ok());
            Closure::<dyn FnMut()>::new(move || {
                let Some(input) = &input else { return };
                match input.type_().as_str() {
                    "text" => ask(Action::SetValue, Some(ActionData::Value(input.value().into()))),
                    _ if input.value_as_number().is_finite() => {
                        ask(Action::SetValue, Some(ActionData::NumericValue(input.value_as_number())));
                    }
                    _ => {}
                }
            })
        };
        let pressed = element.clone();
        let key = Closure::<dyn FnMut(KeyboardEvent)>::new(move |event: KeyboardEvent| {
            if matches!(event.key().as_str(), "Enter" | " ") && pressed.tag_name() == "DIV" {
                event.prevent_default();
                pressed.click();
            }
        });
        Callbacks { press, set, focus: Closure::new(move || ask(Action::Focus, None)), key }
    }
}

/// The id of a control's element.
fn html_id(id: NodeId) -> String {
    format!("control-{}", id.0)
}

impl Element {
    /// Sets what has changed.
    fn set(&mut self, attributes: &[(&'static str, String)]) -> Result<(), JsValue> {
        if self.shown == attributes {
            return Ok(());
        }
        for (name, _) in self.shown.iter().filter(|(name, _)| attributes.iter().all(|(new, _)| new != name)) {
            self.element.remove_attribute(name)?;
        }
        for (name, value) in attributes.iter().filter(|attribute| !self.shown.contains(attribute)) {
            self.element.set_attribute(name, value)?;
        }
        self.shown = attributes.to_vec();
        Ok(())
    }
}

impl Element {
    /// Gives an input the value of its control, unless the user is at it.
    fn show_value(&self, node: &Node) {
        let Some(input) = self.element.dyn_ref::<HtmlInputElement>() else { return };
        let is_used = self.element.owner_document().and_then(|document| document.active_element());
        if is_used.is_some_and(|active| active == ***input) {
            return;
        }
        let value = node.numeric_value().map(|number| number.to_string());
        let value = value.or_else(|| node.value().map(str::to_owned)).unwrap_or_default();
        if input.value() != value {
            input.set_value(&value);
        }
    }
}

/// The role of an element; none where a control has none that a page knows.
fn role(node: &Node) -> Option<&'static str> {
    Some(match node.role() {
        Role::Button | Role::DefaultButton => "button",
        Role::CheckBox | Role::Switch => "checkbox",
        Role::ComboBox | Role::EditableComboBox => "combobox",
        Role::Image => "img",
        Role::Label | Role::Heading | Role::Paragraph => "note",
        Role::Link => "link",
        Role::MenuItem | Role::ListBoxOption => "option",
        Role::RadioButton => "radio",
        Role::Slider => "slider",
        Role::SpinButton => "spinbutton",
        Role::TextInput | Role::MultilineTextInput => "textbox",
        _ => return None,
    })
}

/// What a reader says of a control.
fn name(node: &Node) -> Option<String> {
    let name = node.label().or(node.value())?;
    Some(name.to_owned()).filter(|name| !name.is_empty())
}

fn attributes(role: &'static str, name: String, node: &Node) -> Vec<(&'static str, String)> {
    let bounds = node.bounds().unwrap_or_default();
    let position = format!(
        "{STYLE}left:{:.0}px;top:{:.0}px;width:{:.0}px;height:{:.0}px",
        bounds.x0,
        bounds.y0,
        bounds.width(),
        bounds.height()
    );
    let mut attributes = vec![("role", role.to_owned()), ("aria-label", name), ("style", position)];
    let numbers = [
        ("aria-valuenow", node.numeric_value()),
        ("aria-valuemin", node.min_numeric_value()),
        ("aria-valuemax", node.max_numeric_value()),
        // What the browser lets an input be set to.
        ("min", node.min_numeric_value()),
        ("max", node.max_numeric_value()),
    ];
    attributes.extend(numbers.into_iter().filter_map(|(name, number)| Some((name, number?.to_string()))));
    if let Some(toggled) = node.toggled() {
        let state = if matches!(role, "checkbox" | "radio") { "aria-checked" } else { "aria-pressed" };
        attributes.push((state, (toggled == Toggled::True).to_string()));
    }
    if node.is_disabled() {
        attributes.push(("aria-disabled", "true".into()));
    }
    attributes
}
