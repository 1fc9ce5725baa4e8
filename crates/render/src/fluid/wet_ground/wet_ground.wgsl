// The record of ground that was under water, on a grid over what is shown: when it was last, and how high the water stood.
#import declared

@group(1) @binding(9) var<uniform> wet: WetGround;

// A height as a number that grows with it, for atomicMax: heights on a stage are above -LOWEST.
const LOWEST: f32 = 4.0;

// A position on the grid: middles of cells are at .5.
fn on_wet_grid(position: vec2f) -> vec2f {
    return (position - wet.corner) * wet.per_unit;
}
