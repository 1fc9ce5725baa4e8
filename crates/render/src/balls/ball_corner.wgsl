// A triangle that faces the eye round each ball; its sphere is found pixel by pixel.
#import ball

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) ball: vec4f,
    @location(2) @interpolate(flat) colour: vec3f,
    @location(3) @interpolate(flat) number: u32,
}

@vertex
fn vertex(@builtin(vertex_index) vertex: u32) -> Corner {
    let number = vertex / 3u;
    let ball = sphere(number);
    let round = round_of(ball);
    let corner = corner_of(vertex);
    let position = ball.xyz + round.reach * (corner.x * round.right + corner.y * round.up);
    let clip = select(NOWHERE, view.clip_from_world * vec4f(position, 1.0), is_there(number));
    return Corner(clip, position, ball, colour_of(number), number);
}

// The line of sight through a triangle; nothing is drawn where it misses the sphere.
fn sight_of(corner: Corner) -> Ray {
    let sight = ray_through(corner.position);
    let aside = beside(sight, corner.ball);
    if dot(aside, aside) > corner.ball.w * corner.ball.w {
        discard;
    }
    return sight;
}
