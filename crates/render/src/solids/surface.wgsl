// Corners of a surface.
#import view

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn vertex(vertex: Vertex) -> Corner {
    return Corner(view.clip_from_world * vec4f(vertex.position.xyz, 1.0), vertex.position.xyz, vertex.normal.xyz);
}
