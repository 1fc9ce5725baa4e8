// Notes for the cells of the ground that a particle covers that they are under water now, and how high it stands. What several particles
// write does not depend on their order.
#import view
#import wet_ground

@group(1) @binding(0) var<storage, read> droplets: array<DropletInstance>;
// How many there are, at SPLAT_COUNT.
@group(1) @binding(1) var<storage, read> draw_args: array<u32>;
@group(1) @binding(10) var<storage, read_write> wet_latest: array<atomic<u32>>;
@group(1) @binding(11) var<storage, read_write> wet_levels: array<atomic<u32>>;

@compute @workgroup_size(SPLAT_GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= draw_args[SPLAT_COUNT] {
        return;
    }
    let droplet = droplets[id.x];
    // Balls are in the air.
    if droplet.matter.x <= 0.0 {
        return;
    }
    let middle = on_wet_grid(droplet.position.xy);
    let reach = max(droplet.radius * wet.per_unit, 0.5);
    let most = vec2f(wet.cells);
    let first = vec2u(clamp(floor(middle - reach), vec2f(0.0), most));
    let end = vec2u(clamp(ceil(middle + reach), vec2f(0.0), most));
    let slope = droplet.normal.xy / max(droplet.normal.z, 0.1);
    for (var row = first.y; row < end.y; row++) {
        for (var column = first.x; column < end.x; column++) {
            let away = vec2f(f32(column), f32(row)) + 0.5 - middle;
            if dot(away, away) <= reach * reach {
                let level = droplet.position.z - dot(slope, away) / wet.per_unit;
                let index = row * wet.cells.x + column;
                atomicMax(&wet_latest[index], bitcast<u32>(wet.now));
                atomicMax(&wet_levels[index], bitcast<u32>(max(level + LOWEST, 0.0)));
            }
        }
    }
}
