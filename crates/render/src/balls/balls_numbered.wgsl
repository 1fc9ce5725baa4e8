// Where there are many balls: which of them is seen where.
#import ball_corner

struct Numbered {
    @location(0) number: u32,
    @builtin(frag_depth) depth: f32,
}

// The number of the nearest ball, from 1 on.
@fragment
fn fragment(corner: Corner) -> Numbered {
    let found = hit(sight_of(corner), corner.ball);
    return Numbered(corner.number + 1u, depth_at(found.position));
}
