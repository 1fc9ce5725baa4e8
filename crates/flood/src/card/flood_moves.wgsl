// What the kernels share that move particles and keep them within the edges.
#import flood_card

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read_write> particles: array<Packed>;
@group(0) @binding(5) var<storage, read_write> partials: array<Partial>;

fn sum(pair: vec2f) -> f32 {
    return pair.x + pair.y;
}
