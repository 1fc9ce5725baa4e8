// Bindings of the picture that every shader has (view.rs): group 0.
#import declared

@group(0) @binding(0) var<uniform> view: CameraAndLight;
@group(0) @binding(1) var sun_depth: texture_depth_2d;
@group(0) @binding(2) var sun_compare: sampler_comparison;

// What a fragment shader draws.
struct Drawn {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

// A line of sight: a position on it and its direction, of length 1.
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

// The position that a pixel of a given depth shows. The depth is not 0 where there is perspective.
fn world_at_pixel(pixel: vec2f, depth: f32) -> vec3f {
    let position = view.world_from_clip * vec4f(clip_at_pixel(pixel), depth, 1.0);
    return position.xyz / position.w;
}

// The line of sight through a position.
fn ray_through(position: vec3f) -> Ray {
    let from_eye = position - view.eye.xyz;
    let aside = position - dot(from_eye, view.forward.xyz) * view.forward.xyz;
    let perspective = view.eye.w > 0.5;
    return Ray(
        select(aside, view.eye.xyz, perspective),
        select(view.forward.xyz, normalize(from_eye), perspective),
    );
}

// The line of sight through a pixel.
fn ray_at_pixel(pixel: vec2f) -> Ray {
    // With perspective not by a position near the eye: its digits would be those of the eye.
    let slope = clip_at_pixel(pixel) / vec2f(view.clip_from_view[0][0], view.clip_from_view[1][1]);
    let from_eye = normalize((view.world_from_view * vec4f(slope, -1.0, 0.0)).xyz);
    let level = ray_through(world_at_pixel(pixel, 0.5));
    let perspective = view.eye.w > 0.5;
    return Ray(select(level.origin, view.eye.xyz, perspective), select(level.direction, from_eye, perspective));
}

// The direction from a position to the eye.
fn towards_eye(position: vec3f) -> vec3f {
    return -ray_through(position).direction;
}

// Depth of a position in the target.
fn depth_at(position: vec3f) -> f32 {
    let clip = view.clip_from_world * vec4f(position, 1.0);
    return clip.z / clip.w;
}

// Height of a pixel at a position.
fn pixel_at(position: vec3f) -> f32 {
    let before = max(dot(position - view.eye.xyz, view.forward.xyz), 1e-4);
    return view.forward.w * select(1.0, before, view.eye.w > 0.5);
}
