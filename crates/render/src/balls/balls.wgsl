// Balls one by one, as shaded spheres.
#import ball_corner

@fragment
fn fragment(corner: Corner) -> Drawn {
    let sight = sight_of(corner);
    return shaded(hit(sight, corner.ball), corner.colour, sight, corner.clip.xy);
}

// Spheres in plain light, without shadows and shine.
@fragment
fn fragment_matt(corner: Corner) -> Drawn {
    let sight = sight_of(corner);
    let found = hit(sight, corner.ball);
    return Drawn(vec4f(matt(corner.colour, found.normal, 1.0), 1.0), depth_at(found.place));
}

// To the sun a ball is a disc through its middle: the half that it lights lies before that.
@fragment
fn throw_shadow(corner: Corner) {
    let offset = corner.place - corner.ball.xyz;
    if dot(offset, offset) > corner.ball.w * corner.ball.w {
        discard;
    }
}
