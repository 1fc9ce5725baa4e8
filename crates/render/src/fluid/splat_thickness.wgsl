// Water and foam in lines of sight, twin of fluid_thickness.wgsl without raster units. Whole numbers are added up: their sum is the
// same in any order.
#import droplet_matter
#import fluid
#import splat
#import splat_sums

@group(1) @binding(1) var<storage, read> droplets: array<DropletInstance>;
// How many there are, at SPLAT_COUNT.
@group(1) @binding(2) var<storage, read> draw_args: array<u32>;
// Four sums a pixel, which of them are beyond what they hold, and two sums of the flow that may be below 0.
@group(1) @binding(3) var<storage, read_write> sums: array<atomic<u32>>;

// Particles of the group that all of its threads draw together.
var<workgroup> large: array<u32, SPLAT_GROUP>;
var<workgroup> larges: atomic<u32>;

fn splat(droplet: DropletInstance, quad: Quad, pixel: vec2i, size: vec2f) {
    let at = meeting(quad, pixel, size);
    if !at.met {
        return;
    }
    let matter = matter_at(sprite_at(droplet, quad, at.offset));
    let first = SUMS * (u32(pixel.y) * u32(size.x) + u32(pixel.x));
    let added = vec4u(round(clamp(matter * PER_UNIT, vec4f(0.0), vec4f(MOST_ADDED))));
    for (var part = 0u; part < 4u; part++) {
        if added[part] > 0u {
            let before = atomicAdd(&sums[first + part], added[part]);
            // Once it runs over, in whatever order: only where the whole sum is too great.
            if before > 0xffffffffu - added[part] {
                atomicOr(&sums[first + 4u], 1u << part);
            }
        }
    }
    let flow = vec2i(round(clamp(matter.a * droplet.flow, vec2f(-MOST_FLOW), vec2f(MOST_FLOW)) * PER_FLOW));
    atomicAdd(&sums[first + 5u], bitcast<u32>(flow.x));
    atomicAdd(&sums[first + 6u], bitcast<u32>(flow.y));
}

@compute @workgroup_size(SPLAT_GROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) thread: u32) {
    let size = ceil(0.5 * view.frame.xy);
    if id.x < draw_args[SPLAT_COUNT] {
        let droplet = droplets[id.x];
        let quad = matter_quad(droplet);
        let box = box_of(quad, size);
        let pixels = pixels_in(box);
        if pixels <= MOST_ALONE {
            for (var index = 0; index < pixels; index++) {
                splat(droplet, quad, pixel_in(box, index), size);
            }
        } else {
            large[atomicAdd(&larges, 1u)] = id.x;
        }
    }
    workgroupBarrier();
    let together = atomicLoad(&larges);
    for (var turn = 0u; turn < together; turn++) {
        let droplet = droplets[large[turn]];
        let quad = matter_quad(droplet);
        let box = box_of(quad, size);
        let pixels = pixels_in(box);
        for (var index = i32(thread); index < pixels; index += i32(SPLAT_GROUP)) {
            splat(droplet, quad, pixel_in(box, index), size);
        }
    }
}
