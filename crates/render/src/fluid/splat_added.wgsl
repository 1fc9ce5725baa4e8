// Sums of splats as a texture, as sprites leave them.
#import view
#import splat_sums

@group(1) @binding(0) var<storage, read> sums: array<u32>;
@group(1) @binding(1) var thickness: texture_storage_2d<rgba16float, write>;
@group(1) @binding(2) var flow: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(PIXELS_ACROSS, PIXELS_DOWN)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(thickness);
    if any(id.xy >= size) {
        return;
    }
    let first = SUMS * (id.y * size.x + id.x);
    let sum = vec4f(vec4u(sums[first], sums[first + 1u], sums[first + 2u], sums[first + 3u])) / PER_UNIT;
    let over = (vec4u(sums[first + 4u]) & vec4u(1u, 2u, 4u, 8u)) != vec4u(0u);
    textureStore(thickness, id.xy, select(sum, vec4f(4096.0), over));
    let flowing = vec2f(vec2i(vec2u(sums[first + 5u], sums[first + 6u]))) / PER_FLOW;
    textureStore(flow, id.xy, vec4f(flowing, 0.0, 0.0));
}
