// Counts what has landed among the particles.
#import flood_card
#import flood_air

@group(0) @binding(0) var<storage, read_write> status: Status;
@group(0) @binding(1) var<storage, read_write> air: Air;
@group(0) @binding(2) var<storage, read_write> groups: array<u32>;

@compute @workgroup_size(1)
fn main() {
    let landed = atomicExchange(&air.landed, 0u);
    if landed > 0u {
        status.particles += landed;
        status.falling -= landed;
        groups[0] = (status.particles + 255u) / 256u;
    }
}
