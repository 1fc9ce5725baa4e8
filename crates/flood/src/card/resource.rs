//! What shaders are given to work on.

use corpuscle_gpu::wgpu;

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
