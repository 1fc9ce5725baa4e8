//! Groups of bindings, in the order of their numbers.

use crate::buffer;
use corpuscle_gpu::{Gpu, wgpu};
use wgpu::BindingType;

/// A texture of numbers that a sampler may mix.
pub(super) const MIXED: BindingType = BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Float { filterable: true },
    view_dimension: wgpu::TextureViewDimension::D2,
    multisampled: false,
};
/// A texture of whole numbers.
pub(super) const WHOLE: BindingType = BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Uint,
    view_dimension: wgpu::TextureViewDimension::D2,
    multisampled: false,
};
/// A texture of depth.
pub(super) const DEPTH: BindingType = BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Depth,
    view_dimension: wgpu::TextureViewDimension::D2,
    multisampled: false,
};
/// Numbers that a shader reads.
pub(super) const READ: BindingType = numbers(true);
/// Numbers that a shader changes.
pub(super) const CHANGED: BindingType = numbers(false);
/// A sampler that mixes.
pub(super) const SAMPLER: BindingType = BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
pub(super) use buffer::{TEXTURE as PLAIN, UNIFORM};

/// A texture that a compute shader writes.
pub(super) const fn written(format: wgpu::TextureFormat) -> BindingType {
    BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format,
        view_dimension: wgpu::TextureViewDimension::D2,
    }
}

const fn numbers(read_only: bool) -> BindingType {
    let ty = wgpu::BufferBindingType::Storage { read_only };
    BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None }
}

/// The layout of a group, bindings 0, 1, ...
pub(super) fn layout(
    gpu: &Gpu,
    label: &str,
    visibility: wgpu::ShaderStages,
    bindings: &[BindingType],
) -> wgpu::BindGroupLayout {
    let entry = |(binding, ty): (usize, &BindingType)| wgpu::BindGroupLayoutEntry {
        binding: binding as u32,
        visibility,
        ty: *ty,
        count: None,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &bindings.iter().enumerate().map(entry).collect::<Vec<_>>(),
    })
}

/// A group, bindings 0, 1, ...
pub(super) fn group(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    bound: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
    let entries: Vec<_> = (0..).zip(bound.iter().cloned()).map(entry).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}
