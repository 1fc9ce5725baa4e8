//! Layouts of groups of bindings, read from the shaders that use them.

use crate::reflect::validated;
use naga::{AddressSpace, ImageClass, ImageDimension, ScalarKind, StorageAccess, StorageFormat, TypeInner};
use std::collections::{BTreeMap, BTreeSet};

/// The layout of a group of bindings. Names, numbers and types of its bindings stand in WGSL alone; resources are bound by name.
#[derive(Debug, Clone)]
pub struct GroupLayout {
    label: &'static str,
    layout: wgpu::BindGroupLayout,
    numbers: BTreeMap<String, u32>,
}

/// A binding as shaders declare it.
struct Declared {
    number: u32,
    ty: wgpu::BindingType,
    stages: wgpu::ShaderStages,
}

impl GroupLayout {
    /// The layout of group `group` of shaders that share it, by their whole texts. Textures that one of them samples may be filtered.
    ///
    /// # Errors
    /// A text that is not valid WGSL, two numbers or types of one name, or a type of binding that is not known here.
    pub fn new(device: &wgpu::Device, label: &'static str, group: u32, shaders: &[&str]) -> Result<Self, String> {
        let declared = declared(group, shaders).map_err(|error| format!("{label}: {error}"))?;
        let entry = |binding: &Declared| wgpu::BindGroupLayoutEntry {
            binding: binding.number,
            visibility: binding.stages,
            ty: binding.ty,
            count: None,
        };
        let entries: Vec<_> = declared.values().map(entry).collect();
        let layout =
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries });
        let numbers = declared.into_iter().map(|(name, binding)| (name, binding.number)).collect();
        Ok(Self { label, layout, numbers })
    }

    /// The layout itself, for pipelines.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// A group with a resource for each binding, by its name in WGSL.
    ///
    /// # Panics
    /// If a binding has no resource, or a resource no binding.
    pub fn bind(&self, device: &wgpu::Device, resources: &[(&str, wgpu::BindingResource<'_>)]) -> wgpu::BindGroup {
        let names: BTreeSet<_> = resources.iter().map(|(name, _)| *name).collect();
        assert!(names.iter().copied().eq(self.numbers.keys()), "{}: {:?}, not {names:?}", self.label, self.numbers);
        let numbered = resources.iter().map(|(name, resource)| (self.numbers[*name], resource.clone()));
        let entries: Vec<_> = numbered.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.label),
            layout: &self.layout,
            entries: &entries,
        })
    }
}

/// The bindings of a group in all shaders, by name.
fn declared(group: u32, shaders: &[&str]) -> Result<BTreeMap<String, Declared>, String> {
    let mut all = BTreeMap::<String, Declared>::new();
    for text in shaders {
        let (module, info) = validated(text)?;
        let entries = 0..module.entry_points.len();
        let sampled: BTreeSet<_> =
            entries.flat_map(|entry| info.get_entry_point(entry).sampling_set.iter().map(|key| key.image)).collect();
        let stages = stages(&module);
        for (handle, variable) in module.global_variables.iter() {
            let Some(binding) = variable.binding.as_ref().filter(|binding| binding.group == group) else { continue };
            let name = variable.name.clone().unwrap_or_default();
            let ty = binding_type(&module, variable, sampled.contains(&handle))
                .ok_or_else(|| format!("the type of {name} is not known"))?;
            let new = Declared { number: binding.binding, ty, stages };
            let Some(known) = all.get_mut(&name) else {
                all.insert(name, new);
                continue;
            };
            if known.number != new.number || filtered(known.ty) != filtered(new.ty) {
                return Err(format!("{name} is declared in two ways"));
            }
            known.stages |= stages;
            if new.ty == filtered(new.ty) {
                known.ty = new.ty;
            }
        }
    }
    Ok(all)
}

/// The stages of a shader's entry points; all, for a piece without any.
fn stages(module: &naga::Module) -> wgpu::ShaderStages {
    let stage = |entry: &naga::EntryPoint| match entry.stage {
        naga::ShaderStage::Vertex => wgpu::ShaderStages::VERTEX,
        naga::ShaderStage::Fragment => wgpu::ShaderStages::FRAGMENT,
        _ => wgpu::ShaderStages::COMPUTE,
    };
    match module.entry_points.iter().map(stage).reduce(|all, stage| all | stage) {
        Some(stages) => stages,
        None => wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE,
    }
}

/// The same type, of textures of floating-point numbers that which may be filtered.
fn filtered(ty: wgpu::BindingType) -> wgpu::BindingType {
    match ty {
        wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { .. },
            view_dimension,
            multisampled,
        } => wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension,
            multisampled,
        },
        other => other,
    }
}

fn binding_type(module: &naga::Module, variable: &naga::GlobalVariable, filterable: bool) -> Option<wgpu::BindingType> {
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    match variable.space {
        AddressSpace::Uniform => return Some(buffer(wgpu::BufferBindingType::Uniform)),
        AddressSpace::Storage { access } => {
            let read_only = !access.contains(StorageAccess::STORE);
            return Some(buffer(wgpu::BufferBindingType::Storage { read_only }));
        }
        _ => {}
    }
    match module.types[variable.ty].inner {
        TypeInner::Sampler { comparison: true } => {
            Some(wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison))
        }
        TypeInner::Sampler { comparison: false } => {
            Some(wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering))
        }
        TypeInner::Image { dim: ImageDimension::D2, arrayed: false, class } => image_type(class, filterable),
        _ => None,
    }
}

fn image_type(class: ImageClass, filterable: bool) -> Option<wgpu::BindingType> {
    let texture = |sample_type| wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    match class {
        ImageClass::Sampled { kind, multi: false } => Some(texture(match kind {
            ScalarKind::Float => wgpu::TextureSampleType::Float { filterable },
            ScalarKind::Uint => wgpu::TextureSampleType::Uint,
            ScalarKind::Sint => wgpu::TextureSampleType::Sint,
            _ => return None,
        })),
        ImageClass::Depth { multi: false } => Some(texture(wgpu::TextureSampleType::Depth)),
        ImageClass::Storage { format, access } if access == StorageAccess::STORE => {
            let format = match format {
                StorageFormat::R32Float => wgpu::TextureFormat::R32Float,
                StorageFormat::R32Uint => wgpu::TextureFormat::R32Uint,
                StorageFormat::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
                _ => return None,
            };
            Some(wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::WriteOnly,
                format,
                view_dimension: wgpu::TextureViewDimension::D2,
            })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHADER: &str = "
        @group(1) @binding(3) var<uniform> numbers: vec4f;
        @group(1) @binding(0) var plain: texture_2d<f32>;
        @group(1) @binding(1) var smooth_one: texture_2d<f32>;
        @group(1) @binding(2) var linear: sampler;
        @group(0) @binding(0) var<storage, read> others: array<u32>;
        fn mixed(image: texture_2d<f32>, at: vec2f) -> vec4f { return textureSampleLevel(image, linear, at, 0.0); }
        @fragment fn fragment() -> @location(0) vec4f {
            return numbers + textureLoad(plain, vec2i(0), 0) + mixed(smooth_one, vec2f(0.5)) + f32(others[0]);
        }";

    fn is_filterable(ty: wgpu::BindingType) -> bool {
        matches!(
            ty,
            wgpu::BindingType::Texture { sample_type: wgpu::TextureSampleType::Float { filterable: true }, .. }
        )
    }

    #[test]
    fn bindings_are_read_from_the_shader() {
        let found = declared(1, &[SHADER]).unwrap();
        let numbers: Vec<_> = found.iter().map(|(name, binding)| (name.as_str(), binding.number)).collect();
        assert_eq!(numbers, [("linear", 2), ("numbers", 3), ("plain", 0), ("smooth_one", 1)]);
        assert!(!is_filterable(found["plain"].ty) && is_filterable(found["smooth_one"].ty));
        assert!(found.values().all(|binding| binding.stages == wgpu::ShaderStages::FRAGMENT));
        assert_eq!(declared(0, &[SHADER]).unwrap().len(), 1);
    }

    /// A texture that one of two shaders samples may be filtered, in whichever order they come.
    #[test]
    fn shaders_that_share_a_group_are_taken_together() {
        let loads = "@group(1) @binding(1) var smooth_one: texture_2d<f32>;
            @vertex fn vertex() -> @builtin(position) vec4f { return textureLoad(smooth_one, vec2i(0), 0); }";
        for shaders in [[SHADER, loads], [loads, SHADER]] {
            let found = declared(1, &shaders).unwrap();
            assert!(is_filterable(found["smooth_one"].ty));
            assert_eq!(found["smooth_one"].stages, wgpu::ShaderStages::VERTEX_FRAGMENT);
        }
        let elsewhere = loads.replace("@binding(1)", "@binding(4)");
        assert!(declared(1, &[SHADER, &elsewhere]).is_err_and(|error| error.contains("two ways")));
    }
}
