// What is behind everything, by direction: seen, mirrored, and as light from all round.
#import view

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

// What is seen in a direction, without the sun's disc.
fn surroundings(direction: vec3f) -> vec3f {
    if view.frame.w > 0.5 {
        let up = smoothstep(0.0, 0.9, direction.z);
        let down = smoothstep(0.0, 0.7, -direction.z);
        let walls = mix(mix(view.horizon.rgb, view.above.rgb, up), view.below.rgb, down);
        return walls + select(0.0, 1.0, view.frame.w > 1.1) * window(direction);
    }
    let height = max(direction.z, 0.0);
    // Air gets thicker towards the horizon; light scattered forward makes a glow round the sun.
    let clear = mix(view.horizon.rgb, view.above.rgb, 1.0 - exp(-3.2 * height));
    let near_sun = max(dot(direction, view.sun.xyz), 0.0);
    let glow = 0.25 * pow(near_sun, 12.0) + 0.35 * pow(near_sun, 160.0);
    let sky = clear + glow * vec3f(1.0, 0.88, 0.7);
    return mix(sky, view.below.rgb, smoothstep(0.0, 0.6, -direction.z));
}

// What is seen in a direction, the sun's disc with it.
fn sky(direction: vec3f) -> vec3f {
    let seen = surroundings(direction);
    if view.frame.w > 0.5 {
        return seen;
    }
    let disc = smoothstep(0.99985, 0.99993, dot(direction, view.sun.xyz));
    return seen + disc * 20.0 * view.sunlight.rgb;
}

// Light that comes from all round on a surface, by the cosine of its normal upwards.
fn light_from_all_round(upwards: f32) -> vec3f {
    let overhead = mix(view.horizon.rgb, view.above.rgb, 0.5);
    return view.sunlight.w * mix(view.below.rgb, overhead, 0.5 + 0.5 * upwards);
}
