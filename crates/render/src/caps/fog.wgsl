// Drops too small to be seen one by one: each adds the area that it covers to the pixels round it, as patches of many do.
#import view
#import cap

// Depth of the surfaces that fog may lie on, and of what may hide them.
@group(2) @binding(0) var behind_depth: texture_depth_2d;
@group(2) @binding(1) var hiding_depth: texture_depth_2d;

// Radius over which a droplet is spread, samples.
const SPREAD: f32 = 4.0;
// The same for a patch, in its radii: patches are smooth together.
const PATCH_SPREAD: f32 = 1.9;

struct Corner {
    @builtin(position) clip: vec4f,
    // From the middle, radii of the spread.
    @location(0) offset: vec2f,
    // Samples that it covers.
    @location(1) @interpolate(flat) area: f32,
    @location(2) @interpolate(flat) depth: f32,
    // Radius of the spread, samples.
    @location(3) @interpolate(flat) spread: f32,
    @location(4) @interpolate(flat) number: u32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) number: u32) -> Corner {
    let cap = caps[number];
    let pixel = pixel_at(cap.position);
    let spread = max(SPREAD, select(0.0, PATCH_SPREAD * cap.radius / pixel, cap.covered > 0.0));
    let reach = select(0.0, spread * pixel, is_fine(cap));
    let radius = cap.radius / pixel;
    let facing = dot(cap.out, towards_eye(cap.position));
    let covered = select(1.0, cap.covered, cap.covered > 0.0);
    let area = PI * radius * radius * covered * max(abs(facing), 0.15);
    let offset = 2.0 * vec2f(f32(index & 1u), f32(index >> 1u)) - 1.0;
    // Lifted off its surface, so that this does not hide it.
    let lifted = cap.position + (cap.height + 2.0 * pixel) * towards_eye(cap.position);
    return Corner(facing_corner(index, cap.position, reach), offset, area, depth_at(lifted), spread, number);
}

// Whether a pixel of a depth shows the surface on which a drop or a patch lies, not what is before it; beside a patch also not what is behind.
fn is_on_surface(cap: CapInstance, corner: Corner, depth: f32) -> bool {
    if cap.covered == 0.0 {
        return depth <= corner.depth;
    }
    let away = world_at_pixel(corner.clip.xy, max(depth, 1e-6)) - cap.position;
    let reach = PATCH_SPREAD * cap.radius;
    return depth > 0.0 && length(away) < reach && abs(dot(away, cap.out)) < 0.5 * reach;
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let from_middle = dot(corner.offset, corner.offset);
    let depth = textureLoad(behind_depth, vec2i(corner.clip.xy), 0);
    let hiding = textureLoad(hiding_depth, vec2i(corner.clip.xy), 0);
    if from_middle > 1.0 || hiding > depth || !is_on_surface(caps[corner.number], corner, depth) {
        discard;
    }
    // Weight of a kernel whose sum over all samples is 1.
    let weight = 3.0 / (PI * corner.spread * corner.spread) * (1.0 - from_middle) * (1.0 - from_middle);
    return vec4f(corner.area * weight, 0.0, 0.0, 1.0);
}
