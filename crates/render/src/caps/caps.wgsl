// Drops on a surface: caps of spheres that flow into each other where they come near, found pixel by pixel along the line of
// sight. They bend what is behind them and mirror what is before.
#import light
#import cap

@group(2) @binding(0) var behind: texture_2d<f32>;
@group(2) @binding(1) var behind_sampler: sampler;

const MOST_SIGHT_STEPS: i32 = 28;
// Refractive index of water as drops have it; that of floods is 1.333 (`fluid_shade.wgsl`): each has its reviewed pictures.
const DROP_INDEX: f32 = 1.33;
// The part of the surroundings in what is seen through a drop.
const SURROUNDINGS: f32 = 0.85;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) number: u32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) number: u32) -> Corner {
    let cap = caps[number];
    let middle = cap.position + 0.5 * cap.height * cap.out;
    // Caps higher than half a sphere bulge beyond their disc; necks reach beyond both.
    let bulge = select(cap.radius, sphere_radius(cap), cap.height > cap.radius);
    let reach = 1.05 * length(vec2f(bulge, 0.5 * cap.height)) + 2.0 * settings.neck;
    return Corner(facing_corner(index, middle, select(reach, 0.0, is_fine(cap))), facing_position(index, middle, reach), number);
}

// Distance from the joint surface of a cap and its neighbours, and its slope: spheres joined by the logarithm of the sum of
// exponentials, which does not depend on their order (Quilez, "Smooth minimum", 2013).
fn from_drops(cap: CapInstance, position: vec3f) -> vec4f {
    let own = position - sphere_centre(cap);
    let own_distance = length(own) - sphere_radius(cap);
    var sum = 1.0;
    var slope = normalize(own);
    for (var at = cap.neighbours.x; at < cap.neighbours.x + cap.neighbours.y; at++) {
        let other = caps[neighbours[at]];
        let offset = position - sphere_centre(other);
        let distance = length(offset) - sphere_radius(other);
        let weight = exp(clamp((own_distance - distance) / settings.neck, -30.0, 30.0));
        sum += weight;
        slope += weight * normalize(offset);
    }
    return vec4f(slope / sum, own_distance - settings.neck * log(sum));
}

// Where the line of sight comes into reach of a cap's sphere, and where it goes out; out before in where it misses.
fn reach_of(cap: CapInstance, sight: Ray) -> vec2f {
    let from_centre = sight.origin - sphere_centre(cap);
    let along = dot(from_centre, sight.direction);
    let aside = from_centre - along * sight.direction;
    let radius = sphere_radius(cap) + 2.0 * settings.neck;
    let inside = radius * radius - dot(aside, aside);
    if inside < 0.0 {
        return vec2f(1e9, -1e9);
    }
    return vec2f(-along - sqrt(inside), -along + sqrt(inside));
}

@fragment
fn fragment(corner: Corner) -> Drawn {
    let cap = caps[corner.number];
    let sight = ray_through(corner.position);
    var reach = reach_of(cap, sight);
    for (var at = cap.neighbours.x; at < cap.neighbours.x + cap.neighbours.y; at++) {
        let other = reach_of(caps[neighbours[at]], sight);
        reach = vec2f(min(reach.x, other.x), max(reach.y, other.y));
    }
    var distance = reach.x;
    var found = vec4f(0.0, 0.0, 0.0, 1.0);
    let near_enough = 0.002 * cap.radius;
    for (var step = 0; step < MOST_SIGHT_STEPS; step++) {
        found = from_drops(cap, sight.origin + distance * sight.direction);
        distance += found.w;
        if found.w < near_enough || distance > reach.y {
            break;
        }
    }
    let position = sight.origin + distance * sight.direction;
    if found.w > 20.0 * near_enough || dot(position - cap.position, cap.out) < 0.0 {
        discard;
    }
    return Drawn(vec4f(water(cap, position, normalize(found.xyz), sight.direction), 1.0), depth_at(position));
}

// Light from a position on a drop.
fn water(cap: CapInstance, position: vec3f, normal: vec3f, direction: vec3f) -> vec3f {
    // A drop is a lens, flat on one side: what is near behind it is seen smaller, and what is far upside down.
    let inside = refract(direction, normal, 1.0 / DROP_INDEX);
    let flat = cap.out * -sign(dot(inside, cap.out));
    let through = refract(inside, flat, DROP_INDEX);
    // Where no light leaves by the flat side it is thrown back there.
    let leaving = select(reflect(inside, flat), through, dot(through, through) > 0.0);
    let clip = view.clip_from_world * vec4f(position + (inside - direction) * max(6.0 * cap.radius, 0.02), 1.0);
    let uv = clamp(clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5, vec2f(0.0), vec2f(1.0));
    let near = textureSampleLevel(behind, behind_sampler, uv, 0.0).rgb;
    let seen = mix(near, surroundings(leaving), SURROUNDINGS);
    let fresnel = mirrored(dot(normal, -direction), 0.02);
    // Light from the sun gathers on the far side of a drop and leaves the near one darker.
    let lit = 0.82 + 0.3 * dot(normal, -view.sun.xyz) * (1.0 - fresnel);
    let half_way = normalize(view.sun.xyz - direction);
    let spark = 3.0 * pow(max(dot(normal, half_way), 0.0), 260.0);
    return seen * lit * (1.0 - fresnel) + surroundings(reflect(direction, normal)) * fresnel + spark * view.sunlight.rgb;
}
