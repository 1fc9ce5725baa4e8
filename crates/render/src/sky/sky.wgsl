// What is behind everything, by direction: seen, mirrored, and as light from all round.
#import view
#import noise

// Whether the picture may be in a room, before whose glass walls is a street.
override may_be_in_room: bool = true;

// A window of four panes in a wall towards the sun.
fn window(direction: vec3f) -> vec3f {
    let towards = normalize(vec3f(view.sun.xy, 1e-4));
    let before = dot(direction, towards);
    if before < 0.1 {
        return vec3f(0.0);
    }
    let at = vec2f(dot(direction, vec3f(-towards.y, towards.x, 0.0)), direction.z) / before - vec2f(0.0, 0.75);
    let inside = smoothstep(vec2f(0.0), vec2f(0.06), vec2f(0.42, 0.5) - abs(at)) * smoothstep(vec2f(0.015), vec2f(0.045), abs(at));
    return 2.6 * inside.x * inside.y * vec3f(0.95, 1.0, 1.06);
}

// How far what is out of focus is spread, radians; and how far the street's end lies below the room.
const OUT_OF_FOCUS: f32 = 0.016;
const STREET_BELOW: f32 = 0.2;
// Lights round the circle, where there is one at each position.
const LIGHTS: f32 = 150.0;

// A row of houses in a street, out of focus: colour, and how much of what is behind it hides. `turn` is a part of the circle from 0 to 1; this part of
// the houses is missing.
fn houses(turn: f32, height: f32, count: f32, row: f32, tallest: f32, missing: f32) -> vec4f {
    let along = turn * count;
    let house = floor(along);
    let own = three_scattered(vec2f(house, row));
    let beside = three_scattered(vec2f((house + select(-1.0, 1.0, along - house > 0.5) + count) % count, row));
    let tall = tallest * vec2f(0.35 + 0.65 * own.x, 0.35 + 0.65 * beside.x);
    let roof = select(tall, vec2f(-0.2), vec2f(own.z, beside.z) < vec2f(missing));
    // Half a neighbour at the wall that two houses share.
    let edge = 0.5 - 0.5 * smoothstep(0.0, 2.0 * OUT_OF_FOCUS * count / (2.0 * PI), 0.5 - abs(along - house - 0.5));
    let walls = array(vec3f(0.50, 0.30, 0.23), vec3f(0.74, 0.66, 0.53), vec3f(0.37, 0.41, 0.46), vec3f(0.62, 0.60, 0.57));
    let colour = mix(walls[u32(3.99 * own.y)], walls[u32(3.99 * beside.y)], edge);
    // Floors, nearly lost in the blur.
    let floors = 1.0 + 0.08 * sin(height * 210.0);
    return vec4f(colour * floors, 1.0 - smoothstep(-OUT_OF_FOCUS, OUT_OF_FOCUS, height - mix(roof.x, roof.y, edge)));
}

// Lights out of focus: discs as wide as the aperture.
fn lights(turn: f32, height: f32) -> vec3f {
    var sum = vec3f(0.0);
    let at = LIGHTS * vec2f(turn, height / (2.0 * PI));
    for (var k = 0; k < 4; k++) {
        let cell = floor(at - 0.5) + vec2f(f32(k & 1), f32(k >> 1));
        let own = three_scattered(vec2f((cell.x + LIGHTS) % LIGHTS, cell.y + 7.0));
        let is_lit = own.z > 0.78 && cell.y > -3.5 && cell.y < 2.5;
        let away = length(at - cell - 0.25 - 0.5 * own.xy);
        let disc = (1.0 - smoothstep(0.30, 0.38, away)) * (0.75 + 0.25 * smoothstep(0.15, 0.33, away));
        let hue = mix(vec3f(1.0, 0.72, 0.36), vec3f(1.0, 0.93, 0.82), fract(own.z * 37.0));
        sum += select(0.0, 0.55, is_lit) * disc * hue;
    }
    return sum;
}

// A street on a bright evening, out of focus, all round a room whose walls are glass.
fn street(direction: vec3f) -> vec3f {
    let turn = fract(atan2(direction.y, direction.x) / (2.0 * PI) + 1.0);
    let height = direction.z + STREET_BELOW;
    let dusk = vec3f(1.06, 0.90, 0.74);
    let overhead = mix(dusk, view.above.rgb, smoothstep(0.02, 0.5, height));
    let far = houses(turn, height, 71.0, 1.0, 0.12, 0.0);
    var seen = mix(overhead, mix(far.rgb, dusk, 0.5), far.a);
    let near = houses(turn, height, 37.0, 5.0, 0.22, 0.35);
    seen = mix(seen, 0.85 * near.rgb, near.a);
    // Trees along the pavement.
    let round = 2.0 * PI * turn;
    let crowns = 0.055 + 0.035 * sin(29.0 * round) * sin(11.0 * round + 1.0) + 0.010 * sin(113.0 * round);
    let trees = smoothstep(-0.1, 0.35, sin(29.0 * round + 0.6)) * (1.0 - smoothstep(-OUT_OF_FOCUS, OUT_OF_FOCUS, height - crowns));
    seen = mix(seen, vec3f(0.16, 0.22, 0.10), 0.9 * trees);
    // The wet road mirrors the sky, less and less towards the eye.
    let road = mix(0.62 * dusk, view.below.rgb, smoothstep(0.0, 0.35, -height));
    seen = mix(seen, road, smoothstep(-OUT_OF_FOCUS, OUT_OF_FOCUS, -height - 0.015));
    return seen + lights(turn, height);
}

// What is seen in a direction, without the sun's disc. All is computed and one selected: see the test `no_branch_depends_on_parameters_alone`.
fn surroundings(direction: vec3f) -> vec3f {
    let up = smoothstep(0.0, 0.9, direction.z);
    let down = smoothstep(0.0, 0.7, -direction.z);
    let indoors = mix(mix(view.horizon.rgb, view.above.rgb, up), view.below.rgb, down);
    let height = max(direction.z, 0.0);
    // Air gets thicker towards the horizon; light scattered forward makes a glow round the sun.
    let clear = mix(view.horizon.rgb, view.above.rgb, 1.0 - exp(-3.2 * height));
    let near_sun = max(dot(direction, view.sun.xyz), 0.0);
    let glow = 0.25 * pow(near_sun, 12.0) + 0.35 * pow(near_sun, 160.0);
    let sky = clear + glow * vec3f(1.0, 0.88, 0.7);
    let seen = select(mix(sky, view.below.rgb, smoothstep(0.0, 0.6, -direction.z)), indoors, view.frame.w > 0.5);
    if may_be_in_room {
        return select(seen, street(direction) + window(direction), (view.frame.w > 1.1) & !is_paper());
    }
    return seen;
}

// What is seen in a direction, the sun's disc with it.
fn sky(direction: vec3f) -> vec3f {
    let disc = select(smoothstep(0.99985, 0.99993, dot(direction, view.sun.xyz)), 0.0, view.frame.w > 0.5);
    return surroundings(direction) + disc * 20.0 * view.sunlight.rgb;
}

// Light that comes from all round on a surface, by the cosine of its normal upwards.
fn light_from_all_round(upwards: f32) -> vec3f {
    let overhead = mix(view.horizon.rgb, view.above.rgb, 0.5);
    return view.sunlight.w * mix(view.below.rgb, overhead, 0.5 + 0.5 * upwards);
}
