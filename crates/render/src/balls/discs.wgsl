// Flat discs that face the eye, with a darker rim. A shader of their own: there may be many, and small, and what is known of a disc is
// found once for its corners.
#import ball

struct Corner {
    @builtin(position) clip: vec4f,
    // From the middle, over the radius.
    @location(0) aside: vec2f,
    @location(1) @interpolate(flat) colour: vec3f,
    // Where the rim begins, over the radius; height of a pixel, over the radius; how dark the rim is.
    @location(2) @interpolate(flat) rim: vec3f,
}

@vertex
fn vertex(@builtin(vertex_index) vertex: u32) -> Corner {
    let number = vertex / 3u;
    let disc = sphere(number);
    let aside = corner_of(vertex);
    let across = view.world_from_view * vec4f(aside, 0.0, 0.0);
    let seen = view.clip_from_world * vec4f(disc.xyz + disc.w * across.xyz, 1.0);
    let clip = select(NOWHERE, seen, is_there(number));
    // A pixel of the finished picture wide, and narrower on small ones.
    let pixel = pixel_at(disc.xyz) / disc.w;
    let rim = vec3f(1.0 - min(2.4 * pixel, 0.3), pixel, 0.65 * smoothstep(1.5, 8.0, 1.0 / pixel));
    return Corner(clip, aside, colour_of(number), rim);
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let edge = length(corner.aside);
    if edge > 1.0 {
        discard;
    }
    let dark = clamp((edge - corner.rim.x) / corner.rim.y + 0.5, 0.0, 1.0) * corner.rim.z;
    return vec4f((1.0 - dark) * corner.colour, 1.0);
}
