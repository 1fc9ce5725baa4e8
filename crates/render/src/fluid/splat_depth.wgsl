// The nearest surface of all particles, twin of fluid_depth.wgsl without raster units.
#import droplet_depth
#import splat

@group(1) @binding(1) var<storage, read> droplets: array<DropletInstance>;
// How many there are, at SPLAT_COUNT.
@group(1) @binding(2) var<storage, read> draw_args: array<u32>;
// The bits of the distance at each pixel, the other way round, so that the nearest is the greatest and 0 is nothing: positive numbers
// are in the order of their bits.
@group(1) @binding(3) var<storage, read_write> nearest: array<atomic<u32>>;

// Particles of the group that all of its threads draw together.
var<workgroup> large: array<u32, SPLAT_GROUP>;
var<workgroup> larges: atomic<u32>;

fn splat(droplet: DropletInstance, quad: Quad, pixel: vec2i, size: vec2f) {
    let at = meeting(quad, pixel, size);
    if !at.met {
        return;
    }
    let surface = surface_at(sprite_at(droplet, quad, at.offset));
    if surface.met {
        let distance = max(distance_of(surface.position), 0.0);
        atomicMax(&nearest[u32(pixel.y) * u32(size.x) + u32(pixel.x)], ~bitcast<u32>(distance));
    }
}

@compute @workgroup_size(SPLAT_GROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) thread: u32) {
    let size = view.frame.xy;
    if id.x < draw_args[SPLAT_COUNT] {
        let droplet = droplets[id.x];
        let quad = surface_quad(droplet);
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
        let quad = surface_quad(droplet);
        let box = box_of(quad, size);
        let pixels = pixels_in(box);
        for (var index = i32(thread); index < pixels; index += i32(SPLAT_GROUP)) {
            splat(droplet, quad, pixel_in(box, index), size);
        }
    }
}
