//! One declaration of what the host and the shaders of a model share: constants, structures and bindings.
//!
//! [`declare!`](crate::declare) makes of it the Rust items and their WGSL text. A shader takes the text in by the line `#import declared`; of the bindings it gets those
//! that it uses, read-only where it does not write. The host gives buffers by the names of the bindings.

use crate::reflect::{Use, uses};
use crate::{ImportError, ShaderLibrary, join};

/// The name by which shaders import a declaration.
pub const DECLARED: &str = "declared";

/// A type that the host and shaders share.
pub trait Shared {
    /// Its WGSL name.
    fn wgsl() -> String;

    /// Name and text of the piece of a shader that defines it; none where the declaration itself does.
    fn piece() -> Option<(&'static str, String)> {
        None
    }
}

/// A type of constants that the host and shaders share.
pub trait SharedConstant: Shared {
    /// The value as a WGSL literal that reads back to the same bits.
    fn literal(self) -> String;
}

macro_rules! shared {
    ($($type:ty => $wgsl:literal),* $(,)?) => {
        $(impl Shared for $type {
            fn wgsl() -> String {
                $wgsl.into()
            }
        })*
    };
}

shared! {
    f32 => "f32", u32 => "u32", i32 => "i32", AtomicU32 => "atomic<u32>", AtomicI32 => "atomic<i32>",
}

/// A number that threads of a shader change at the same time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct AtomicU32(pub u32);

/// The same with a sign.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct AtomicI32(pub i32);

/// Two to four numbers are a vector, more an array.
fn vector(number: &str, letter: char, count: usize) -> String {
    if (2..=4).contains(&count) { format!("vec{count}{letter}") } else { format!("array<{number}, {count}>") }
}

impl<const N: usize> Shared for [f32; N] {
    fn wgsl() -> String {
        vector("f32", 'f', N)
    }
}

/// A matrix, column by column.
impl Shared for [[f32; 4]; 4] {
    fn wgsl() -> String {
        "mat4x4f".into()
    }
}

impl<const N: usize> Shared for [u32; N] {
    fn wgsl() -> String {
        vector("u32", 'u', N)
    }
}

impl<const N: usize> Shared for [i32; N] {
    fn wgsl() -> String {
        vector("i32", 'i', N)
    }
}

/// Two numbers.
impl SharedConstant for [f32; 2] {
    fn literal(self) -> String {
        format!("vec2f({}, {})", self[0].literal(), self[1].literal())
    }
}

impl<const N: usize> Shared for [[u32; 4]; N] {
    fn wgsl() -> String {
        format!("array<vec4u, {N}>")
    }
}

impl<const N: usize> Shared for [[f32; 2]; N] {
    fn wgsl() -> String {
        format!("array<vec2f, {N}>")
    }
}

impl<T: SharedStruct, const N: usize> Shared for [T; N] {
    fn wgsl() -> String {
        format!("array<{}, {N}>", T::wgsl())
    }
}

impl<T: Shared> Shared for [T] {
    fn wgsl() -> String {
        format!("array<{}>", T::wgsl())
    }
}

impl SharedConstant for f32 {
    fn literal(self) -> String {
        format!("{self:?}f")
    }
}

impl SharedConstant for u32 {
    fn literal(self) -> String {
        format!("{self}u")
    }
}

/// A member of a structure as Rust lays it out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// Its name.
    pub name: &'static str,
    /// Its WGSL type.
    pub wgsl: String,
    /// Bytes before it.
    pub offset: usize,
    /// Its size, bytes.
    pub size: usize,
}

/// A structure as Rust lays it out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// Its name.
    pub name: &'static str,
    /// Its size, bytes.
    pub size: usize,
    /// Its members in their order.
    pub members: Vec<Member>,
}

impl Layout {
    /// The structure in WGSL.
    pub fn wgsl(&self) -> String {
        let members: String = self.members.iter().map(|m| format!("    {}: {},\n", m.name, m.wgsl)).collect();
        format!("struct {} {{\n{members}}}\n", self.name)
    }

    /// The same as vertex shaders take it in: member by member, at locations from 0 on.
    pub fn wgsl_of_vertex(&self) -> String {
        let line = |(number, m): (usize, &Member)| format!("    @location({number}) {}: {},\n", m.name, m.wgsl);
        format!("struct {} {{\n{}}}\n", self.name, self.members.iter().enumerate().map(line).collect::<String>())
    }

    /// Where a vertex shader finds the members in a vertex buffer of such structures.
    ///
    /// # Panics
    /// Where a member is no number or vector of `f32` or `u32`: vertex shaders take in nothing else.
    pub fn vertex_attributes(&self) -> Vec<wgpu::VertexAttribute> {
        let attribute = |(location, member): (u32, &Member)| wgpu::VertexAttribute {
            format: vertex_format(&member.wgsl).expect("members of vertices are numbers or vectors"),
            offset: member.offset as u64,
            shader_location: location,
        };
        (0..).zip(&self.members).map(attribute).collect()
    }
}

fn vertex_format(wgsl: &str) -> Option<wgpu::VertexFormat> {
    Some(match wgsl {
        "f32" => wgpu::VertexFormat::Float32,
        "vec2f" => wgpu::VertexFormat::Float32x2,
        "vec3f" => wgpu::VertexFormat::Float32x3,
        "vec4f" => wgpu::VertexFormat::Float32x4,
        "u32" => wgpu::VertexFormat::Uint32,
        "vec2u" => wgpu::VertexFormat::Uint32x2,
        _ => return None,
    })
}

/// A structure of [`declare!`](crate::declare).
pub trait SharedStruct: Shared {
    /// How Rust lays it out.
    fn layout() -> Layout;
}

/// Constants and structures that several declarations include: see [`declare!`](crate::declare).
pub trait SharedPiece {
    /// The constants as WGSL lines.
    fn constants() -> Vec<String>;

    /// The structures in their order.
    fn structs() -> Vec<Layout>;

    /// All in WGSL.
    fn wgsl() -> String {
        Self::constants().into_iter().chain(Self::structs().iter().map(Layout::wgsl)).collect()
    }
}

/// A buffer of shaders.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binding {
    /// Its name.
    pub name: &'static str,
    /// Its WGSL type.
    pub wgsl: String,
    /// A uniform buffer; else a storage buffer.
    pub is_uniform: bool,
    /// See [`Shared::piece`].
    pub piece: Option<(&'static str, String)>,
}

/// A declaration as [`declare!`](crate::declare) makes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Declaration {
    /// The constants as WGSL lines.
    pub constants: Vec<String>,
    /// The structures in their order.
    pub structs: Vec<Layout>,
    /// The bindings by their numbers, all in group 0.
    pub bindings: Vec<Binding>,
}

impl Declaration {
    /// Constants and structures in WGSL.
    pub fn types(&self) -> String {
        self.constants.iter().cloned().chain(self.structs.iter().map(Layout::wgsl)).collect()
    }

    /// Pieces that define types of bindings.
    fn pieces(&self) -> Vec<(&'static str, &str)> {
        let all = self.bindings.iter().filter_map(|binding| binding.piece.as_ref());
        let mut pieces: Vec<_> = all.map(|(name, text)| (*name, text.as_str())).collect();
        pieces.dedup();
        pieces
    }

    /// Whether some of it is atomic, which WGSL has only where shaders may write.
    fn has_atomics(&self, binding: &Binding) -> bool {
        let is_atomic = |wgsl: &str| wgsl.contains("atomic<");
        let names = |c: char| !c.is_alphanumeric() && c != '_';
        let holds = |layout: &&Layout| binding.wgsl.split(names).any(|name| name == layout.name);
        let members = self.structs.iter().filter(holds).flat_map(|layout| &layout.members);
        is_atomic(&binding.wgsl) || members.map(|member| member.wgsl.as_str()).any(is_atomic)
    }

    /// All in WGSL, with the bindings for which `used` gives how a shader uses them.
    fn wgsl(&self, used: impl Fn(u32) -> Option<Use>) -> String {
        let line = |(number, binding): (u32, &Binding)| {
            let space = match (binding.is_uniform, used(number)?) {
                (true, _) => "uniform",
                (false, Use::Read) if !self.has_atomics(binding) => "storage, read",
                (false, _) => "storage, read_write",
            };
            let Binding { name, wgsl, .. } = binding;
            Some(format!("@group(0) @binding({number}) var<{space}> {name}: {wgsl};\n"))
        };
        let import = |(name, _): &(&str, &str)| format!("#import {name}\n");
        let imports: String = self.pieces().iter().map(import).collect();
        [imports, self.types()].into_iter().chain((0..).zip(&self.bindings).filter_map(line)).collect()
    }

    /// The text of a shader joined from its pieces, with the bindings that its functions use; and the numbers of those that its entry points use.
    ///
    /// # Errors
    /// [`ImportError::Missing`], and [`ImportError::Invalid`] where the text is no valid WGSL.
    pub fn complete(
        &self,
        name: &str,
        text: &str,
        library: ShaderLibrary<'_>,
    ) -> Result<(String, Vec<u32>), ImportError> {
        let with = |declared: &str| {
            let library: Vec<_> = library.iter().copied().chain([(DECLARED, declared)]).chain(self.pieces()).collect();
            join(name, text, &library)
        };
        let invalid = |reason| ImportError::Invalid { shader: name.into(), reason };
        let used = uses(&with(&self.wgsl(|_| Some(Use::Written)))?).map_err(invalid)?;
        let text = with(&self.wgsl(|number| used.by_any.get(&number).copied()))?;
        Ok((text, used.by_entries.into_iter().collect()))
    }
}

/// What the device holds for a declaration of [`declare!`](crate::declare): a buffer for each binding.
pub trait Buffers {
    /// The declaration.
    fn declaration() -> Declaration;

    /// The buffers by the numbers of their bindings.
    fn in_order(&self) -> Vec<&wgpu::Buffer>;
}

/// Declares what the host and the shaders of a model share.
///
/// ```
/// corpuscle_gpu::declare! {
///     constants {
///         /// Gravity, m/s2.
///         pub const GRAVITY: f32 = 9.81;
///     }
///     structs {
///         /// A column of water.
///         pub struct Column {
///             /// m/s.
///             pub velocity: [f32; 2],
///             /// Depth, m.
///             pub depth: f32,
///             /// Fills up: WGSL aligns `vec2f` to 8 bytes.
///             pub unused: f32,
///         }
///     }
///
///     /// What the passes work on.
///     pub buffers Memory {
///         /// Numbers that stay as they are.
///         uniform sizes: [u32; 4],
///         /// The water.
///         storage columns: [Column],
///     }
/// }
/// ```
///
/// gives the constant, a `#[repr(C)]` structure that can be copied to the device, and `Memory`, with a buffer for each binding, numbered in their order.
/// [`check_layouts`](crate::check_layouts) says in a test where WGSL would lay a structure out otherwise.
///
/// What several models share is declared with `pub piece Name;` in the place of the buffers. Declarations take it in by a first line `include [Name]`, as those of models
/// that take steps do with [`Stepping`](crate::Stepping).
#[macro_export]
macro_rules! declare {
    (
        $(include [$($included:ty),+ $(,)?])?
        constants { $($constants:tt)* }
        structs { $($structs:tt)* }
        $(#[$buffers_doc:meta])* $buffers_vis:vis buffers $buffers:ident {
            $($(#[$binding_doc:meta])* $space:ident $binding:ident: $binding_type:ty),+ $(,)?
        }
    ) => {
        $crate::declare!(@constants $($constants)*);
        $crate::declare!(@structs $($structs)*);

        $(#[$buffers_doc])*
        #[derive(Debug, Clone)]
        $buffers_vis struct $buffers {
            $($(#[$binding_doc])* pub $binding: $crate::wgpu::Buffer),+
        }

        impl $crate::Buffers for $buffers {
            fn declaration() -> $crate::Declaration {
                let constants = [$($(<$included as $crate::SharedPiece>::constants(),)+)? $crate::declare!(@lines $($constants)*)];
                let structs = [$($(<$included as $crate::SharedPiece>::structs(),)+)? $crate::declare!(@layouts $($structs)*)];
                $crate::Declaration {
                    constants: constants.into_iter().flatten().collect(),
                    structs: structs.into_iter().flatten().collect(),
                    bindings: vec![$($crate::Binding {
                        name: stringify!($binding),
                        wgsl: <$binding_type as $crate::Shared>::wgsl(),
                        piece: <$binding_type as $crate::Shared>::piece(),
                        is_uniform: $crate::declare!(@is_uniform $space),
                    }),+],
                }
            }

            fn in_order(&self) -> Vec<&$crate::wgpu::Buffer> {
                vec![$(&self.$binding),+]
            }
        }
    };
    (
        constants { $($constants:tt)* }
        structs { $($structs:tt)* }
        $(#[$piece_doc:meta])* $piece_vis:vis piece $piece:ident;
    ) => {
        $crate::declare!(@constants $($constants)*);
        $crate::declare!(@structs $($structs)*);

        $(#[$piece_doc])*
        #[derive(Debug, Clone, Copy)]
        $piece_vis struct $piece;

        impl $crate::SharedPiece for $piece {
            fn constants() -> Vec<String> {
                $crate::declare!(@lines $($constants)*)
            }

            fn structs() -> Vec<$crate::Layout> {
                $crate::declare!(@layouts $($structs)*)
            }
        }
    };
    (@constants $($(#[$doc:meta])* $vis:vis const $name:ident: $type:ty = $value:expr;)*) => {
        $($(#[$doc])* $vis const $name: $type = $value;)*
    };
    (@lines $($(#[$doc:meta])* $vis:vis const $name:ident: $type:ty = $value:expr;)*) => {
        vec![$(format!(
            "const {}: {} = {};\n",
            stringify!($name),
            <$type as $crate::Shared>::wgsl(),
            $crate::SharedConstant::literal($name),
        )),*]
    };
    (@structs $($(#[$doc:meta])* $vis:vis struct $name:ident {
        $($(#[$member_doc:meta])* $member_vis:vis $member:ident: $type:ty),+ $(,)?
    })*) => {
        $(
            $(#[$doc])*
            #[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
            #[repr(C)]
            $vis struct $name {
                $($(#[$member_doc])* $member_vis $member: $type),+
            }

            impl Default for $name {
                fn default() -> Self {
                    bytemuck::Zeroable::zeroed()
                }
            }

            impl $crate::Shared for $name {
                fn wgsl() -> String {
                    stringify!($name).into()
                }
            }

            impl $crate::SharedStruct for $name {
                fn layout() -> $crate::Layout {
                    $crate::Layout {
                        name: stringify!($name),
                        size: size_of::<Self>(),
                        members: vec![$($crate::Member {
                            name: stringify!($member),
                            wgsl: <$type as $crate::Shared>::wgsl(),
                            offset: std::mem::offset_of!(Self, $member),
                            size: size_of::<$type>(),
                        }),+],
                    }
                }
            }
        )*
    };
    (@layouts $($(#[$doc:meta])* $vis:vis struct $name:ident { $($members:tt)* })*) => {
        vec![$(<$name as $crate::SharedStruct>::layout()),*]
    };
    (@is_uniform uniform) => { true };
    (@is_uniform storage) => { false };
}
