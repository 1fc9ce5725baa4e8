// Drops as the device has them (caps/mod.rs). Group 1.
#import view

@group(1) @binding(0) var<storage, read> caps: array<CapInstance>;
@group(1) @binding(1) var<storage, read> neighbours: array<u32>;
@group(1) @binding(2) var<uniform> settings: CapUniforms;

// Radius of the sphere from those of the disc and the cap's height.
fn sphere_radius(cap: CapInstance) -> f32 {
    return (cap.radius * cap.radius + cap.height * cap.height) / (2.0 * cap.height);
}

fn sphere_centre(cap: CapInstance) -> vec3f {
    return cap.position + (cap.height - sphere_radius(cap)) * cap.out;
}

// True for drops too small to be seen one by one, and for patches of such drops.
fn is_fine(cap: CapInstance) -> bool {
    return cap.covered > 0.0 || cap.radius < settings.finest * pixel_at(cap.position);
}

// A corner of a square that faces the eye.
fn facing_position(index: u32, middle: vec3f, reach: f32) -> vec3f {
    let sight = ray_through(middle);
    let aside = select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(sight.direction.z) > 0.9);
    let right = normalize(cross(sight.direction, aside));
    let up = cross(right, sight.direction);
    let corner = 2.0 * vec2f(f32(index & 1u), f32(index >> 1u)) - 1.0;
    return middle + reach * (corner.x * right + corner.y * up);
}

fn facing_corner(index: u32, middle: vec3f, reach: f32) -> vec4f {
    return view.clip_from_world * vec4f(facing_position(index, middle, reach), 1.0);
}
