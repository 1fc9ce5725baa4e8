// What the toolkit draws (letters, grounds, lines, images), as triangles in points.
#import declared

@group(0) @binding(0) var<uniform> window: WindowSize;
@group(1) @binding(0) var image: texture_2d<f32>;
@group(1) @binding(1) var image_sampler: sampler;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) colour: vec4f,
}

@vertex
fn vertex(vertex: MeshVertex) -> Corner {
    let part = 2.0 * vertex.position / window.size - 1.0;
    return Corner(vec4f(part.x, -part.y, 0.0, 1.0), vertex.uv, unpack4x8unorm(vertex.colour));
}

// Letters stand on whole pixels, and their images are as large as they are shown: nothing is to be filtered.
@fragment
fn fragment_letters(corner: Corner) -> @location(0) vec4f {
    return corner.colour * textureLoad(image, vec2u(corner.uv * vec2f(textureDimensions(image))), 0);
}

@fragment
fn fragment_image(corner: Corner) -> @location(0) vec4f {
    return corner.colour * textureSampleLevel(image, image_sampler, corner.uv, 0.0);
}
