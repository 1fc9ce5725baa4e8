// Balls one by one: shaded spheres, flat discs on paper.
#import ball_corner

@fragment
fn fragment(corner: Corner) -> Drawn {
    let sight = sight_of(corner);
    if is_paper() {
        // A darker rim, a pixel of the finished picture wide and narrower on small ones.
        let edge = length(corner.place - corner.ball.xyz);
        let inner = corner.ball.w - min(2.4 * view.forward.w, 0.3 * corner.ball.w);
        let rim = smoothstep(inner - 0.5 * view.forward.w, inner + 0.5 * view.forward.w, edge);
        let large = smoothstep(1.5, 8.0, corner.ball.w / view.forward.w);
        return Drawn(vec4f(mix(corner.colour, 0.35 * corner.colour, rim * large), 1.0), depth_at(corner.ball.xyz));
    }
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
