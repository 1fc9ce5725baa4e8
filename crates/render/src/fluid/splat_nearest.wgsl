// Distances of splats as a texture, as sprites leave them.
#import view

@group(1) @binding(0) var<storage, read> nearest: array<u32>;
@group(1) @binding(1) var distances: texture_storage_2d<r32float, write>;

@compute @workgroup_size(PIXELS_ACROSS, PIXELS_DOWN)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(distances);
    if any(id.xy >= size) {
        return;
    }
    let bits = nearest[id.y * size.x + id.x];
    textureStore(distances, id.xy, vec4f(select(bitcast<f32>(~bits), 0.0, bits == 0u), 0.0, 0.0, 0.0));
}
