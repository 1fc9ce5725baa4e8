// What every shader knows of the picture (view.rs). Group 0. All in stage coordinates: the half diagonal of what is shown is 1.
// Depth is 1 near and 0 far; nothing drawn is 0.

struct View {
    clip_from_world: mat4x4f,
    world_from_clip: mat4x4f,
    view_from_world: mat4x4f,
    world_from_view: mat4x4f,
    clip_from_view: mat4x4f,
    view_from_clip: mat4x4f,
    sun_from_world: mat4x4f,
    // Place of the eye; 1 with perspective, 0 without.
    eye: vec4f,
    // Line of sight; height of a pixel, at distance 1 where there is perspective.
    forward: vec4f,
    // Direction towards the sun; tangent of half the angle it fills.
    sun: vec4f,
    // Its light; strength of the light from all round.
    sunlight: vec4f,
    above: vec4f,
    horizon: vec4f,
    below: vec4f,
    // Width and height of the target, pixels; metres in a stage unit; 0 sky, 1 studio, 1.25 room, 2 paper.
    frame: vec4f,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var sun_depth: texture_depth_2d;
@group(0) @binding(2) var sun_compare: sampler_comparison;

// A line of sight: a place on it and its direction, of length 1.
struct Ray {
    origin: vec3f,
    direction: vec3f,
}

fn is_paper() -> bool {
    return view.frame.w > 1.5;
}

// Where a pixel of the target (its middle at .5) is in clip space, x and y.
fn clip_at_pixel(pixel: vec2f) -> vec2f {
    return vec2f(2.0, -2.0) * pixel / view.frame.xy + vec2f(-1.0, 1.0);
}

// The place that a pixel of a given depth shows. The depth is not 0 where there is perspective.
fn world_at_pixel(pixel: vec2f, depth: f32) -> vec3f {
    let place = view.world_from_clip * vec4f(clip_at_pixel(pixel), depth, 1.0);
    return place.xyz / place.w;
}

// The line of sight through a place.
fn ray_through(place: vec3f) -> Ray {
    let from_eye = place - view.eye.xyz;
    let aside = place - dot(from_eye, view.forward.xyz) * view.forward.xyz;
    let perspective = view.eye.w > 0.5;
    return Ray(
        select(aside, view.eye.xyz, perspective),
        select(view.forward.xyz, normalize(from_eye), perspective),
    );
}

// The line of sight through a pixel.
fn ray_at_pixel(pixel: vec2f) -> Ray {
    if view.eye.w > 0.5 {
        // Not by a place near the eye: its digits would be those of the eye.
        let slope = clip_at_pixel(pixel) / vec2f(view.clip_from_view[0][0], view.clip_from_view[1][1]);
        return Ray(view.eye.xyz, normalize((view.world_from_view * vec4f(slope, -1.0, 0.0)).xyz));
    }
    return ray_through(world_at_pixel(pixel, 0.5));
}

// The direction from a place to the eye.
fn towards_eye(place: vec3f) -> vec3f {
    return -ray_through(place).direction;
}

// Depth of a place in the target.
fn depth_at(place: vec3f) -> f32 {
    let clip = view.clip_from_world * vec4f(place, 1.0);
    return clip.z / clip.w;
}

// Height of a pixel at a place.
fn pixel_at(place: vec3f) -> f32 {
    let before = max(dot(place - view.eye.xyz, view.forward.xyz), 1e-4);
    return view.forward.w * select(1.0, before, view.eye.w > 0.5);
}
