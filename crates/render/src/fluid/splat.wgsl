// Particles drawn by compute shaders, for GPUs whose few raster units small sprites keep waiting: which pixels a quad covers.
#import droplet

// A quad of more pixels is drawn by all threads of a group.
const MOST_ALONE = 1024;

// Pixels from `low` on, before `high`.
struct Box {
    low: vec2i,
    high: vec2i,
}

// Those of a picture of `size` pixels that a quad may cover.
fn box_of(quad: Quad, size: vec2f) -> Box {
    var low = size;
    var high = vec2f(0.0);
    for (var index = 0u; index < 4u; index++) {
        let clip = view.clip_from_world * vec4f(quad.middle + corner_of(quad, index), 1.0);
        // A quad that reaches to the eye or behind it may be anywhere. Nearer than the nearest that is drawn z is beyond w.
        if clip.w <= max(clip.z, 0.0) {
            return Box(vec2i(0), vec2i(size));
        }
        let pixel = (clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5) * size;
        low = min(low, pixel);
        high = max(high, pixel);
    }
    return Box(vec2i(floor(clamp(low, vec2f(0.0), size))), vec2i(ceil(clamp(high, vec2f(0.0), size))));
}

fn pixels_in(box: Box) -> i32 {
    let sides = max(box.high - box.low, vec2i(0));
    return sides.x * sides.y;
}

// A pixel of a box, row by row.
fn pixel_in(box: Box, index: i32) -> vec2i {
    let wide = box.high.x - box.low.x;
    return box.low + vec2i(index % wide, index / wide);
}

// Where a pixel's line of sight meets a quad.
struct Meeting {
    offset: vec3f,
    met: bool,
}

fn meeting(quad: Quad, pixel: vec2i, size: vec2f) -> Meeting {
    let ray = ray_at_pixel((vec2f(pixel) + 0.5) / size * view.frame.xy);
    let sight = ray_through(quad.middle).direction;
    let to = quad.middle - ray.origin;
    let along = dot(to, sight) / dot(ray.direction, sight);
    let offset = along * ray.direction - to;
    let sides = vec2f(dot(quad.across, quad.across), dot(quad.up, quad.up));
    let at = abs(vec2f(dot(offset, quad.across), dot(offset, quad.up)));
    let clip = view.clip_from_world * vec4f(quad.middle + offset, 1.0);
    // As sprites, it is seen between the nearest and the farthest that is drawn.
    let seen = clip.w > 0.0 && clip.z >= 0.0 && clip.z <= clip.w;
    return Meeting(offset, all(at <= sides) && seen);
}
