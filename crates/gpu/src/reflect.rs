//! What shaders say of themselves: which bindings they use, how their structures are laid out, and whether they keep to the portable floor.

use crate::{Declaration, Layout};
use naga::proc::Layouter;
use naga::valid::{Capabilities, GlobalUse, ModuleInfo, ValidationFlags, Validator};
use std::collections::{BTreeMap, BTreeSet};

/// Threads in a group at most, on the portable floor.
pub const MOST_THREADS: u32 = 256;

/// Storage buffers that a stage uses at most, on the portable floor.
pub const MOST_STORAGE_BUFFERS: usize = 8;

/// How a shader uses a binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Use {
    Read,
    Written,
}

/// Reads and validates a shader with no capability: what WebGPU has without any feature.
pub(crate) fn validated(text: &str) -> Result<(naga::Module, ModuleInfo), String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string(text))?;
    Ok((module, info))
}

/// Bindings of group 0 that a shader uses.
#[derive(Debug, Default)]
pub(crate) struct Uses {
    /// How its functions use them, called or not.
    pub by_any: BTreeMap<u32, Use>,
    /// Those that entry points use.
    pub by_entries: BTreeSet<u32>,
}

/// The bindings of group 0 that a shader uses.
pub(crate) fn uses(text: &str) -> Result<Uses, String> {
    let (module, info) = validated(text)?;
    let entries = (0..module.entry_points.len()).map(|entry| (info.get_entry_point(entry), true));
    let functions = module.functions.iter().map(|(handle, _)| (&info[handle], false));
    let mut uses = Uses::default();
    for (function, is_entry) in functions.chain(entries) {
        for (handle, variable) in module.global_variables.iter() {
            let used = function[handle];
            let Some(binding) = variable.binding.as_ref().filter(|_| !used.is_empty()) else { continue };
            let how = if used.contains(GlobalUse::WRITE) { Use::Written } else { Use::Read };
            let known = uses.by_any.entry(binding.binding).or_insert(how);
            if how == Use::Written {
                *known = how;
            }
            if is_entry {
                uses.by_entries.insert(binding.binding);
            }
        }
    }
    Ok(uses)
}

/// The first line of a shader that declares a variable without a value. It is to be zero, each time where it stands in a loop; Chromium's own
/// compiler (156, on SwiftShader) left in such a structure what the turn before had put there.
fn without_value(text: &str) -> Option<&str> {
    let is_bare = |line: &&str| {
        let declared = line.trim_start().strip_prefix("var ").map(|rest| rest.split("//").next().unwrap_or_default());
        declared.is_some_and(|declared| declared.contains(':') && !declared.contains('='))
    };
    text.lines().find(is_bare)
}

/// Whether a shader is valid, gives every variable a value and keeps to the portable floor.
///
/// # Errors
/// What is wrong with it.
pub fn check_shader(text: &str) -> Result<(), String> {
    if let Some(line) = without_value(text) {
        return Err(format!("a variable has no value: {}", line.trim()));
    }
    let (module, info) = validated(text)?;
    for (number, entry) in module.entry_points.iter().enumerate() {
        let threads: u32 = entry.workgroup_size.iter().product();
        if threads > MOST_THREADS {
            return Err(format!("{} has {threads} threads a group", entry.name));
        }
        let used = info.get_entry_point(number);
        let is_storage = |space: naga::AddressSpace| matches!(space, naga::AddressSpace::Storage { .. });
        let variables = module.global_variables.iter();
        let buffers = variables.filter(|(handle, variable)| is_storage(variable.space) && !used[*handle].is_empty());
        let count = buffers.count();
        if count > MOST_STORAGE_BUFFERS {
            return Err(format!("{} uses {count} storage buffers", entry.name));
        }
    }
    Ok(())
}

/// Whether WGSL lays the structures of a declaration out as Rust does.
///
/// # Errors
/// The first member whose offset or size differs.
pub fn check_layouts(declaration: &Declaration) -> Result<(), String> {
    check_layouts_in(&declaration.types(), &declaration.structs)
}

/// The same for structures that a WGSL text declares.
///
/// # Errors
/// The first member whose name, offset or size differs.
pub fn check_layouts_in(text: &str, layouts: &[Layout]) -> Result<(), String> {
    let (module, _) = validated(text)?;
    let mut sizes = Layouter::default();
    sizes.update(module.to_ctx()).map_err(|error| error.to_string())?;
    for layout in layouts {
        let named = |ty: &naga::Type| ty.name.as_deref() == Some(layout.name);
        let found = module.types.iter().find(|(_, ty)| named(ty)).map(|(_, ty)| &ty.inner);
        let Some(naga::TypeInner::Struct { members, span }) = found else {
            return Err(format!("there is no struct {}", layout.name));
        };
        let of_wgsl = |member: &naga::StructMember| {
            let name = member.name.clone().unwrap_or_default();
            (name, member.offset as usize, sizes[member.ty].size as usize)
        };
        let wgsl: Vec<_> = members.iter().map(of_wgsl).collect();
        let rust: Vec<_> = layout.members.iter().map(|m| (m.name.to_owned(), m.offset, m.size)).collect();
        if let Some((wgsl, rust)) = wgsl.iter().zip(&rust).find(|(wgsl, rust)| wgsl != rust) {
            return Err(format!("{}: WGSL has (name, offset, size) {wgsl:?} where Rust has {rust:?}", layout.name));
        }
        if wgsl.len() != rust.len() || *span as usize != layout.size {
            let (size, count) = (layout.size, rust.len());
            return Err(format!(
                "{}: WGSL has {} members in {span} bytes, Rust {count} in {size}",
                layout.name,
                wgsl.len()
            ));
        }
    }
    Ok(())
}
