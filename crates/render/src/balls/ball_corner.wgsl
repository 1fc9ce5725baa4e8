// A triangle that faces the eye round each ball; its sphere is found pixel by pixel.
#import ball

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    @location(1) @interpolate(flat) ball: vec4f,
    @location(2) @interpolate(flat) colour: vec3f,
    @location(3) @interpolate(flat) number: u32,
}

@vertex
fn vertex(@builtin(vertex_index) vertex: u32) -> Corner {
    let number = vertex / 3u;
    let ball = sphere(number);
    let centre = ball.xyz;
    let sight = ray_through(centre);
    // The cone of lines that touch the sphere cuts the plane through its centre in a larger circle.
    var reach = ball.w;
    if view.eye.w > 0.5 {
        let distance = length(centre - view.eye.xyz);
        reach = ball.w * distance / sqrt(max(distance * distance - ball.w * ball.w, 1e-12));
    }
    let aside = select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(sight.direction.z) > 0.9);
    let right = normalize(cross(sight.direction, aside));
    let up = cross(right, sight.direction);
    let corner = corner_of(vertex);
    let place = centre + reach * (corner.x * right + corner.y * up);
    return Corner(view.clip_from_world * vec4f(place, 1.0), place, ball, colour_of(number), number);
}

// The line of sight through a triangle; nothing is drawn where it misses the sphere.
fn sight_of(corner: Corner) -> Ray {
    let sight = ray_through(corner.place);
    let aside = beside(sight, corner.ball);
    if dot(aside, aside) > corner.ball.w * corner.ball.w {
        discard;
    }
    return sight;
}
