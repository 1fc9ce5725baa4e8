//! One declaration for host and shaders.

use corpuscle_gpu::{
    Buffers, Gpu, Kernel, Layout, Pass, SharedStruct, check_layouts, check_layouts_in, check_shader, filled, read,
    require_gpu, storage, uniform, wait_for, wgpu,
};

corpuscle_gpu::declare! {
    constants {
    /// A third.
    const THIRD: f32 = 1.0 / 3.0;
    /// The smallest number of full precision.
    const TINY: f32 = f32::MIN_POSITIVE;
    /// Twelve.
    const DOZEN: u32 = 12;
    }
    structs {
    /// Numbers of several sizes.
    struct Mixed {
        /// Two numbers.
        pair: [f32; 2],
        /// One.
        first: f32,
        /// Another of the same type.
        second: f32,
        /// A whole number.
        count: u32,
        /// Fills up to a multiple of 8 bytes.
        unused: u32,
    }

    /// A structure in a structure.
    struct Outer {
        /// Four numbers.
        row: [f32; 4],
        /// The other.
        inner: Mixed,
        /// Fills up.
        unused: [u32; 2],
    }
    }

    /// What the test's kernel works on.
    buffers Memory {
        /// A number.
        uniform sizes: [u32; 4],
        /// Not used by the kernel.
        storage spare: [f32],
        /// Read only.
        storage given: [Outer],
        /// Written.
        storage found: [f32],
    }
}

mod included {
    use corpuscle_gpu::AtomicU32;

    corpuscle_gpu::declare! {
        constants {
        /// Seven.
        pub const SEVEN: u32 = 7;
        }
        structs {
        /// A corner.
        pub struct Corner {
            /// Where.
            pub position: [f32; 3],
            /// How large.
            pub radius: f32,
            /// Which.
            pub number: u32,
            /// Fills up.
            pub unused: u32,
            /// Fills up.
            pub unused_more: [u32; 2],
        }
        }

        /// For others.
        pub piece Corners;
    }

    corpuscle_gpu::declare! {
        include [Corners]
        constants {}
        structs {
        /// Counts of the passes.
        pub struct Counts {
            /// A number that threads change.
            pub changed: AtomicU32,
            /// One that they do not.
            pub all: u32,
        }

        /// Its name holds that of another.
        pub struct MoreCounts {
            /// A number.
            pub count: u32,
        }
        }

        /// What kernels work on.
        pub buffers Memory {
            /// Has atomics.
            storage counts: Counts,
            /// Has none.
            storage more: [MoreCounts],
            /// Of the piece.
            storage corners: [Corner],
        }
    }
}

mod misaligned {
    corpuscle_gpu::declare! {
        constants {}
        structs {
        /// WGSL would leave 4 bytes before the pair.
        pub struct Column {
            /// A number.
            depth: f32,
            /// Two.
            pair: [f32; 2],
        }
        }

        /// Nothing that is used.
        pub buffers Memory {
            /// The structure.
            storage columns: [Column],
        }
    }
}

const KERNEL: &str = "#import declared
@compute @workgroup_size(1)
fn main() {
    let outer = given[sizes.x];
    found[0] = outer.row.w;
    found[1] = outer.inner.pair.y;
    found[2] = outer.inner.first - outer.inner.second;
    found[3] = f32(outer.inner.count + DOZEN);
    found[4] = THIRD;
    found[5] = TINY;
}
";

#[test]
fn rust_and_wgsl_lay_structures_out_alike() {
    check_layouts(&Memory::declaration()).unwrap();
}

/// Of one type, so that nothing but the names tells.
#[test]
fn a_swapped_member_is_found() {
    let declaration = Memory::declaration();
    let text = declaration.types();
    check_layouts_in(&text, &declaration.structs).unwrap();
    let swapped = text.replace("    first: f32,\n    second: f32,\n", "    second: f32,\n    first: f32,\n");
    assert!(swapped != text);
    let error = check_layouts_in(&swapped, &declaration.structs).unwrap_err();
    assert!(error.contains("Mixed") && error.contains("second"), "{error}");
    for (from, to) in [("    count: u32,\n", ""), ("count: u32", "count: vec2u"), ("unused: u32", "unused: vec4u")] {
        assert!(check_layouts_in(&text.replace(from, to), &declaration.structs).is_err(), "{from}");
    }
}

#[test]
fn a_member_that_wgsl_places_elsewhere_is_found() {
    let error = check_layouts(&misaligned::Memory::declaration()).unwrap_err();
    assert!(error.contains("Column") && error.contains("pair"), "{error}");
}

#[test]
fn a_shader_gets_the_bindings_that_it_uses() {
    let (text, used) = Memory::declaration().complete("test", KERNEL, &[]).unwrap();
    assert_eq!(used, [0, 2, 3]);
    for line in [
        "@group(0) @binding(0) var<uniform> sizes: vec4u;",
        "@group(0) @binding(2) var<storage, read> given: array<Outer>;",
        "@group(0) @binding(3) var<storage, read_write> found: array<f32>;",
    ] {
        assert!(text.contains(line), "{text}");
    }
    assert!(!text.contains("spare"));
    // A function that no entry point calls needs the binding in the text, and no buffer.
    let with_function = format!("{KERNEL}fn idle() {{\n    spare[0] = 1.0;\n}}\n");
    let (text, used) = Memory::declaration().complete("test", &with_function, &[]).unwrap();
    assert!(used == [0, 2, 3] && text.contains("var<storage, read_write> spare"), "{used:?} {text}");
    check_shader(&text).unwrap();
    check_shader(&text).unwrap();
    assert!(check_shader(&text.replace("@workgroup_size(1)", "@workgroup_size(512)")).is_err());
    let bare = format!("{text}fn bare() {{\n    var sum: vec3f; // of all\n}}\n");
    assert!(check_shader(&bare).unwrap_err().contains("var sum: vec3f;"));
    check_shader(&bare.replace(": vec3f", " = vec3f()")).unwrap();
    let unknown = Memory::declaration().complete("test", &KERNEL.replace("found[0]", "lost[0]"), &[]).unwrap_err();
    assert!(unknown.to_string().contains("lost"), "{unknown}");
}

#[test]
fn what_is_included_is_declared_and_atomics_are_never_read_only() {
    let text = "#import declared
@compute @workgroup_size(1)
fn main() {
    corners[0].number = SEVEN + counts.all + more[0].count;
}
";
    let declaration = included::Memory::declaration();
    check_layouts(&declaration).unwrap();
    let (text, _) = declaration.complete("test", text, &[]).unwrap();
    for line in ["var<storage, read_write> counts: Counts;", "var<storage, read> more: array<MoreCounts>;"] {
        assert!(text.contains(line), "{text}");
    }
    check_shader(&text).unwrap();
}

#[test]
fn a_vertex_buffer_is_laid_out_as_the_structure() {
    let layout = included::Corner::layout();
    assert!(layout.wgsl_of_vertex().contains("    @location(1) radius: f32,\n"), "{}", layout.wgsl_of_vertex());
    let found: Vec<_> = layout.members[..3].iter().map(|member| (member.name, member.offset as u64)).collect();
    assert_eq!(found, [("position", 0), ("radius", 12), ("number", 16)]);
    let vertex = Layout { members: layout.members[..3].to_vec(), ..layout };
    let attributes = vertex.vertex_attributes();
    let told: Vec<_> = attributes.iter().map(|a| (a.format, a.offset, a.shader_location)).collect();
    let formats = [wgpu::VertexFormat::Float32x3, wgpu::VertexFormat::Float32, wgpu::VertexFormat::Uint32];
    assert_eq!(told, [(formats[0], 0, 0), (formats[1], 12, 1), (formats[2], 16, 2)]);
}

#[test]
fn what_the_host_writes_the_device_reads() {
    let Some(gpu) = require_gpu("a declaration") else { return };
    let inner = Mixed { pair: [1.0, 2.0], first: 7.5, second: 3.25, count: 30, unused: 0 };
    let outer = Outer { row: [0.0, 0.0, 0.0, 9.0], inner, unused: [0; 2] };
    let memory = memory(&gpu, &[Outer::default(), outer]);
    let task = Kernel::new(&gpu, "test", KERNEL, &[]).on(&gpu, &memory);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    task.run(&mut Pass::begin(&mut encoder, None), 1);
    gpu.queue.submit([encoder.finish()]);
    let found: Vec<f32> = wait_for(read(&gpu, &memory.found, 6)).unwrap();
    assert_eq!(found, [9.0, 2.0, 4.25, 42.0, 1.0 / 3.0, f32::MIN_POSITIVE]);
}

fn memory(gpu: &Gpu, given: &[Outer]) -> Memory {
    Memory {
        sizes: uniform(gpu, "sizes", &[1_u32, 0, 0, 0]),
        spare: storage::<f32>(gpu, "spare", 1).unwrap(),
        given: filled(gpu, "given", given).unwrap(),
        found: storage::<f32>(gpu, "found", 6).unwrap(),
    }
}
