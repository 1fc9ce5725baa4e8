// Round tubes along lines: a box for each piece, in which the line of sight meets a cylinder with round ends. Flat on paper.
#import light

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    // One end and the radius.
    @location(1) @interpolate(flat) from_end: vec4f,
    // The other end; 1 with shading.
    @location(2) @interpolate(flat) to_end: vec4f,
    @location(3) @interpolate(flat) colour: vec3f,
}

// Corners of a cube as one strip of triangles: bits choose the ends.
const STRIP = array<u32, 14>(3u, 7u, 1u, 5u, 4u, 7u, 6u, 3u, 2u, 1u, 0u, 4u, 2u, 6u);

@vertex
fn vertex(@builtin(vertex_index) index: u32, tube: TubeInstance) -> Corner {
    let from_end = tube.from_end;
    let to_end = tube.to_end;
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
    let position = middle + along * corner.x * (0.5 * long + radius) + radius * (right * corner.y + up * corner.z);
    return Corner(view.clip_from_world * vec4f(position, 1.0), position, vec4f(from_end.xyz, radius), vec4f(to_end.xyz, tube.colour.w), tube.colour.rgb);
}

// Nearest crossing of a line, given from near the axis and across it, and a circle round it: offset and direction across,
// radius. Far below 0 where they miss.
fn crossing(offset: vec3f, direction: vec3f, radius: f32) -> f32 {
    let a = dot(direction, direction);
    let b = dot(offset, direction);
    let inside = b * b - a * (dot(offset, offset) - radius * radius);
    if inside < 0.0 || a < 1e-12 {
        return -1e9;
    }
    return (-b - sqrt(inside)) / a;
}

// Where the line of sight meets the tube, a cylinder with round ends; nothing is drawn where it does not. All is reckoned from
// the point of the axis nearest to the box's side: the radius is small against the length.
fn hit(corner: Corner) -> vec3f {
    let sight = ray_through(corner.position);
    let radius = corner.from_end.w;
    let way = corner.to_end.xyz - corner.from_end.xyz;
    let long = length(way);
    let along = select(vec3f(1.0, 0.0, 0.0), way / max(long, 1e-20), long > 1e-9);
    let start = clamp(dot(corner.position - corner.from_end.xyz, along), 0.0, long);
    let nearest = corner.from_end.xyz + start * along;
    let offset = corner.position - nearest;
    let across = offset - dot(offset, along) * along;
    let distance = crossing(across, sight.direction - dot(sight.direction, along) * along, radius);
    let part = start + dot(offset + distance * sight.direction, along);
    if distance > -1e8 && part >= 0.0 && part <= long {
        return corner.position + distance * sight.direction;
    }
    var found = -1e9;
    for (var end = 0; end < 2; end++) {
        let middle = select(corner.from_end.xyz, corner.to_end.xyz, end == 1);
        let round = crossing(corner.position - middle, sight.direction, radius);
        if round > -1e8 && (found < -1e8 || round < found) {
            found = round;
        }
    }
    if found < -1e8 {
        discard;
    }
    return corner.position + found * sight.direction;
}

@fragment
fn fragment(corner: Corner) -> Drawn {
    let position = hit(corner);
    if is_paper() | (corner.to_end.w < 0.5) {
        return Drawn(vec4f(corner.colour, 1.0), depth_at(position));
    }
    let way = corner.to_end.xyz - corner.from_end.xyz;
    let part = clamp(dot(position - corner.from_end.xyz, way) / max(dot(way, way), 1e-20), 0.0, 1.0);
    let normal = normalize(position - corner.from_end.xyz - part * way);
    let shine = sunshine(position, normal, corner.clip.xy);
    return Drawn(vec4f(coated(corner.colour, normal, towards_eye(position), shine, 0.6), 1.0), depth_at(position));
}

@fragment
fn throw_shadow(corner: Corner) -> @builtin(frag_depth) f32 {
    return depth_at(hit(corner));
}
