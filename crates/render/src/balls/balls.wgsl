// Balls one by one, as shaded spheres.
#import ball_corner

@fragment
fn fragment(corner: Corner) -> Drawn {
    let sight = sight_of(corner);
    return shaded(hit(sight, corner.ball), corner.colour, sight, corner.clip.xy);
}

// To the sun a ball is a disc through its middle: the half that it lights lies before that.
@fragment
fn throw_shadow(corner: Corner) {
    let offset = corner.position - corner.ball.xyz;
    if dot(offset, offset) > corner.ball.w * corner.ball.w {
        discard;
    }
}
