//! Elements of the page that stand for the window's controls: screen readers read them and press them by name.

use egui::accesskit::{Action, ActionRequest, Node, NodeId, Role, Toggled, TreeId, TreeUpdate};
use egui::{Context, Event, FullOutput, Plugin, RawInput};
use send_wrapper::SendWrapper;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::time::Duration;
use wasm_bindgen::prelude::*;
use web_sys::{Document, HtmlElement};
use web_time::Instant;

/// Time between two updates of the elements.
const UPDATE: Duration = Duration::from_millis(250);
/// An element lies where its control is drawn, is not seen, and leaves the pointer to the canvas.
const STYLE: &str = "position:absolute;overflow:hidden;opacity:0;pointer-events:none;";

/// The plugin that keeps the elements. A browser has one thread, which alone touches them.
pub(super) struct Elements(SendWrapper<Page>);

struct Page {
    document: Document,
    holder: HtmlElement,
    elements: HashMap<NodeId, Element>,
    /// Controls that were pressed by their elements.
    pressed: Rc<RefCell<Vec<NodeId>>>,
    updated: Option<Instant>,
}

struct Element {
    element: HtmlElement,
    /// Its attributes as they stand.
    shown: Vec<(&'static str, String)>,
    /// Called when it is pressed.
    _press: Closure<dyn FnMut()>,
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
        let page = Page { document, holder, elements: HashMap::new(), pressed: Rc::default(), updated: None };
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
        for target_node in self.0.pressed.take() {
            let request = ActionRequest { action: Action::Click, target_tree: TreeId::ROOT, target_node, data: None };
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
            let stays = shown.contains_key(id);
            if !stays {
                element.element.remove();
            }
            stays
        });
        for (id, (role, name, node)) in shown {
            if !self.elements.contains_key(&id) {
                let element = self.element(id, context)?;
                self.elements.insert(id, element);
            }
            if let Some(element) = self.elements.get_mut(&id) {
                element.set(&attributes(role, name, node))?;
            }
        }
        Ok(())
    }

    fn element(&self, id: NodeId, context: &Context) -> Result<Element, JsValue> {
        let element: HtmlElement = self.document.create_element("div")?.dyn_into()?;
        let (pressed, context) = (self.pressed.clone(), context.clone());
        let press = Closure::<dyn FnMut()>::new(move || {
            pressed.borrow_mut().push(id);
            context.request_repaint();
        });
        element.set_onclick(Some(press.as_ref().unchecked_ref()));
        self.holder.append_child(&element)?;
        Ok(Element { element, shown: Vec::new(), _press: press })
    }
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
    let place = format!(
        "{STYLE}left:{:.0}px;top:{:.0}px;width:{:.0}px;height:{:.0}px",
        bounds.x0,
        bounds.y0,
        bounds.width(),
        bounds.height()
    );
    let mut attributes = vec![("role", role.to_owned()), ("aria-label", name), ("style", place)];
    if let Some(number) = node.numeric_value() {
        attributes.push(("aria-valuenow", number.to_string()));
    }
    if let Some(toggled) = node.toggled() {
        attributes.push(("aria-pressed", (toggled == Toggled::True).to_string()));
    }
    if node.is_disabled() {
        attributes.push(("aria-disabled", "true".into()));
    }
    attributes
}
