// Spheres in plain light, without shadows and shine. A shader of their own: there may be many, and what is known of a sphere is found
// once for its corners. Each is seen along the line of sight through its middle, as if the eye were far away,
// and is as near as its middle: software that need not ask the shader for depth leaves out what is hidden.
#import ball

struct Corner {
    @builtin(position) clip: vec4f,
    // From the middle, over the radius as it is seen.
    @location(0) aside: vec2f,
    @location(1) @interpolate(flat) colour: vec3f,
    // The sun, and upwards, from the sphere: to the right, up and towards the eye.
    @location(2) @interpolate(flat) sun: vec3f,
    @location(3) @interpolate(flat) upwards: vec3f,
}

@vertex
fn vertex(@builtin(vertex_index) vertex: u32) -> Corner {
    let number = vertex / 3u;
    let ball = sphere(number);
    let round = round_of(ball);
    let aside = corner_of(vertex);
    let position = ball.xyz + round.reach * (aside.x * round.right + aside.y * round.up);
    let turned = mat3x3f(round.right, round.up, -round.sight);
    return Corner(
        select(NOWHERE, view.clip_from_world * vec4f(position, 1.0), is_there(number)),
        aside,
        colour_of(number),
        view.sun.xyz * turned,
        vec3f(0.0, 0.0, 1.0) * turned,
    );
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let out = dot(corner.aside, corner.aside);
    if out > 1.0 {
        discard;
    }
    let normal = vec3f(corner.aside, sqrt(max(1.0 - out, 0.0)));
    let light = matt_turned(corner.colour, dot(normal, corner.sun), dot(normal, corner.upwards), 1.0);
    return vec4f(light, 1.0);
}
