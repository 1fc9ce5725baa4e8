//! What shaders are given to work on.

use super::tasks::LIBRARY;
use corpuscle_gpu::{Gpu, Kernel, Task, wgpu};

/// The shader of a file of this folder, and what it works on, in the order of its bindings: buffers, textures, or `()` for what it leaves alone.
macro_rules! shader {
    ($gpu:expr, $name:literal, [$($resource:expr),*]) => {
        crate::card::resource::task(
            $gpu,
            $name,
            include_str!(concat!($name, ".wgsl")),
            &[$(crate::card::resource::Resource::from(&$resource)),*],
        )
    };
}
pub(super) use shader;

/// A shader, joined from the pieces of this folder, with what it works on.
pub(super) fn task(gpu: &Gpu, name: &'static str, text: &str, resources: &[Resource<'_>]) -> Task {
    Kernel::new(gpu, name, text, LIBRARY).on_those(gpu, resources.iter().map(Resource::binding))
}

/// What a shader works on.
pub(super) enum Resource<'a> {
    Buffer(&'a wgpu::Buffer),
    Texture(&'a wgpu::TextureView),
    /// The shader leaves it alone.
    Unused,
}

impl<'a> Resource<'a> {
    pub fn binding(&self) -> Option<wgpu::BindingResource<'a>> {
        match *self {
            Self::Buffer(buffer) => Some(buffer.as_entire_binding()),
            Self::Texture(texture) => Some(wgpu::BindingResource::TextureView(texture)),
            Self::Unused => None,
        }
    }
}

impl<'a> From<&'a wgpu::Buffer> for Resource<'a> {
    fn from(buffer: &'a wgpu::Buffer) -> Self {
        Self::Buffer(buffer)
    }
}

impl<'a> From<&&'a wgpu::Buffer> for Resource<'a> {
    fn from(buffer: &&'a wgpu::Buffer) -> Self {
        Self::Buffer(buffer)
    }
}

impl<'a> From<&&'a wgpu::TextureView> for Resource<'a> {
    fn from(texture: &&'a wgpu::TextureView) -> Self {
        Self::Texture(texture)
    }
}

impl From<&()> for Resource<'_> {
    fn from((): &()) -> Self {
        Self::Unused
    }
}

impl<'a> From<&'a wgpu::TextureView> for Resource<'a> {
    fn from(texture: &'a wgpu::TextureView) -> Self {
        Self::Texture(texture)
    }
}
