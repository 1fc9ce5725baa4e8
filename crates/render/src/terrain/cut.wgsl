// Corners of a surface that is cut upright.
#import view

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
    // Depth below the surface, in stage units.
    @location(2) deep: f32,
}

@vertex
fn vertex(vertex: Vertex) -> Corner {
    let position = vertex.position;
    return Corner(view.clip_from_world * vec4f(position.xyz, 1.0), position.xyz, vertex.normal.xyz, position.w);
}
