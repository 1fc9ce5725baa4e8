// Drops too small to be seen one by one: each adds the area that it covers to the pixels round it.
#import view
#import cap

@group(2) @binding(0) var behind_depth: texture_depth_2d;

// Radius over which a droplet is spread, samples.
const SPREAD: f32 = 4.0;

struct Corner {
    @builtin(position) clip: vec4f,
    // From the middle, radii of the spread.
    @location(0) offset: vec2f,
    // Samples that it covers.
    @location(1) @interpolate(flat) area: f32,
    @location(2) @interpolate(flat) depth: f32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) number: u32) -> Corner {
    let cap = caps[number];
    let pixel = pixel_at(cap.place);
    let reach = select(0.0, SPREAD * pixel, is_fine(cap));
    let radius = cap.radius / pixel;
    let facing = dot(cap.out, towards_eye(cap.place));
    let area = 3.14159265 * radius * radius * max(facing, 0.15);
    let offset = 2.0 * vec2f(f32(index & 1u), f32(index >> 1u)) - 1.0;
    // Lifted off its surface, so that this does not hide it.
    let lifted = cap.place + (cap.height + 2.0 * pixel) * towards_eye(cap.place);
    return Corner(facing_corner(index, cap.place, reach), offset, area, depth_at(lifted));
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let from_middle = dot(corner.offset, corner.offset);
    if from_middle > 1.0 || textureLoad(behind_depth, vec2i(corner.clip.xy), 0) > corner.depth {
        discard;
    }
    // A bell whose sum over all samples is 1.
    let bell = 3.0 / (3.14159265 * SPREAD * SPREAD) * (1.0 - from_middle) * (1.0 - from_middle);
    return vec4f(corner.area * bell, 0.0, 0.0, 1.0);
}
