// Corners of a surface that is cut upright.
#import view

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
    // Depth below the surface, in stage units.
    @location(2) deep: f32,
}

@vertex
fn vertex(vertex: Vertex) -> Corner {
    let place = vertex.place;
    return Corner(view.clip_from_world * vec4f(place.xyz, 1.0), place.xyz, vertex.normal.xyz, place.w);
}
