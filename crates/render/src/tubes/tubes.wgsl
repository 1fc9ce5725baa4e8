// Round tubes along lines: a box for each piece, in which the line of sight meets a cylinder with round ends. Flat on paper.
#import light

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    // One end and the radius.
    @location(1) @interpolate(flat) from_end: vec4f,
    // The other end; 1 with shading.
    @location(2) @interpolate(flat) to_end: vec4f,
    @location(3) @interpolate(flat) colour: vec3f,
}

// Corners of a cube as one strip of triangles: bits choose the ends.
const STRIP = array<u32, 14>(3u, 7u, 1u, 5u, 4u, 7u, 6u, 3u, 2u, 1u, 0u, 4u, 2u, 6u);

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @location(0) from_end: vec4f,
    @location(1) to_end: vec4f,
    @location(2) colour: vec4f,
) -> Corner {
    let middle = 0.5 * (from_end.xyz + to_end.xyz);
    let radius = max(from_end.w, to_end.w * pixel_at(middle));
    let way = to_end.xyz - from_end.xyz;
    let long = length(way);
    let along = select(vec3f(1.0, 0.0, 0.0), way / max(long, 1e-20), long > 1e-9);
    let aside = select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(along.z) > 0.9);
    let right = normalize(cross(along, aside));
    let up = cross(right, along);
    let bits = STRIP[index];
    let corner = vec3f(vec3u(bits & 1u, (bits >> 1u) & 1u, (bits >> 2u) & 1u)) * 2.0 - 1.0;
    let place = middle + along * corner.x * (0.5 * long + radius) + radius * (right * corner.y + up * corner.z);
    return Corner(view.clip_from_world * vec4f(place, 1.0), place, vec4f(from_end.xyz, radius), vec4f(to_end.xyz, colour.w), colour.rgb);
}

// Distance along a line of sight to a cylinder with round ends; below 0 where it misses.
// Quilez, "Capsule intersection" (iquilezles.org/articles/intersectors).
fn meets(sight: Ray, from_end: vec3f, to_end: vec3f, radius: f32) -> f32 {
    let way = to_end - from_end;
    let from_from = sight.origin - from_end;
    let way_way = dot(way, way);
    let way_sight = dot(way, sight.direction);
    let way_from = dot(way, from_from);
    let sight_from = dot(sight.direction, from_from);
    let a = way_way - way_sight * way_sight;
    let b = way_way * sight_from - way_from * way_sight;
    let c = way_way * dot(from_from, from_from) - way_from * way_from - radius * radius * way_way;
    let inside = b * b - a * c;
    if inside < 0.0 {
        return -1.0;
    }
    let side = (-b - sqrt(inside)) / max(a, 1e-20);
    let part = way_from + side * way_sight;
    if part > 0.0 && part < way_way {
        return side;
    }
    let end = select(sight.origin - to_end, from_from, part <= 0.0);
    let near = dot(sight.direction, end);
    let round = near * near - dot(end, end) + radius * radius;
    if round < 0.0 {
        return -1.0;
    }
    return -near - sqrt(round);
}

// Where the line of sight meets the tube; nothing is drawn where it does not.
fn hit(corner: Corner) -> vec3f {
    var sight = ray_through(corner.place);
    // From near the tube: numbers stay small.
    let start = dot(corner.from_end.xyz - sight.origin, sight.direction);
    sight.origin += start * sight.direction;
    let distance = meets(sight, corner.from_end.xyz, corner.to_end.xyz, corner.from_end.w);
    if distance == -1.0 {
        discard;
    }
    return sight.origin + distance * sight.direction;
}

struct Drawn {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(corner: Corner) -> Drawn {
    let place = hit(corner);
    if is_paper() || corner.to_end.w < 0.5 {
        return Drawn(vec4f(corner.colour, 1.0), depth_at(place));
    }
    let way = corner.to_end.xyz - corner.from_end.xyz;
    let part = clamp(dot(place - corner.from_end.xyz, way) / max(dot(way, way), 1e-20), 0.0, 1.0);
    let normal = normalize(place - corner.from_end.xyz - part * way);
    let shine = sunshine(place, normal, corner.clip.xy);
    return Drawn(vec4f(coated(corner.colour, normal, towards_eye(place), shine, 0.6), 1.0), depth_at(place));
}

@fragment
fn throw_shadow(corner: Corner) -> @builtin(frag_depth) f32 {
    return depth_at(hit(corner));
}
