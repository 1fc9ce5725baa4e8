// How wet ground is that was under water.
#import wet_ground

@group(1) @binding(10) var<storage, read> wet_latest: array<u32>;
@group(1) @binding(11) var<storage, read> wet_levels: array<u32>;

// Wet ground gives back so much less light.
const WET: f32 = 0.4;

// From 1 at a position that is or was just under water to 0 where it has dried, was never under water, or is above where the water stood.
fn wetness(position: vec3f) -> f32 {
    let at = on_wet_grid(position.xy) - 0.5;
    let low = floor(at);
    let part = at - low;
    var sum = 0.0;
    for (var corner = 0u; corner < 4u; corner++) {
        let step = vec2u(corner & 1u, corner >> 1u);
        let cell = vec2i(low) + vec2i(step);
        if any(cell < vec2i(0)) || any(cell >= vec2i(wet.cells)) {
            continue;
        }
        let index = u32(cell.y) * wet.cells.x + u32(cell.x);
        let latest = wet_latest[index];
        if latest > 0u {
            let level = bitcast<f32>(wet_levels[index]) - LOWEST;
            let left = exp((bitcast<f32>(latest) - wet.now) * wet.drying);
            let below = 1.0 - smoothstep(level, level + wet.soaked, position.z);
            let share = mix(1.0 - part, part, vec2f(step));
            sum += share.x * share.y * left * below;
        }
    }
    return clamp(sum, 0.0, 1.0);
}
