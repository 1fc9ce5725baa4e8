// Drops on a surface: caps of spheres, found pixel by pixel along the line of sight. They bend what is behind them and mirror
// what is before.
#import light

@group(1) @binding(0) var behind: texture_2d<f32>;
@group(1) @binding(1) var behind_sampler: sampler;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    // Middle of the covered disc and its radius.
    @location(1) @interpolate(flat) disc: vec4f,
    // The way out of the surface, and the cap's height.
    @location(2) @interpolate(flat) cap: vec4f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @location(0) disc: vec4f, @location(1) cap: vec4f) -> Corner {
    let sight = ray_through(disc.xyz);
    let aside = select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(sight.direction.z) > 0.9);
    let right = normalize(cross(sight.direction, aside));
    let up = cross(right, sight.direction);
    let corner = 2.0 * vec2f(f32(index & 1u), f32(index >> 1u)) - 1.0;
    let middle = disc.xyz + 0.5 * cap.w * cap.xyz;
    // Caps higher than half a sphere bulge beyond their disc.
    let bulge = select(disc.w, (disc.w * disc.w + cap.w * cap.w) / (2.0 * cap.w), cap.w > disc.w);
    let reach = 1.05 * length(vec2f(bulge, 0.5 * cap.w));
    let place = middle + reach * (corner.x * right + corner.y * up);
    return Corner(view.clip_from_world * vec4f(place, 1.0), place, disc, cap);
}

struct Drawn {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(corner: Corner) -> Drawn {
    let height = corner.cap.w;
    let out = corner.cap.xyz;
    // Radius of the sphere from those of the disc and the cap's height.
    let radius = (corner.disc.w * corner.disc.w + height * height) / (2.0 * height);
    let centre = corner.disc.xyz + (height - radius) * out;
    let sight = ray_through(corner.place);
    let from_centre = sight.origin - centre;
    let along = dot(from_centre, sight.direction);
    let aside = from_centre - along * sight.direction;
    let inside = radius * radius - dot(aside, aside);
    if inside < 0.0 {
        discard;
    }
    let normal = (aside - sqrt(inside) * sight.direction) / radius;
    let place = centre + radius * normal;
    if dot(place - corner.disc.xyz, out) < 0.0 {
        discard;
    }
    let to_eye = -sight.direction;
    // A drop is a lens: what is behind is seen upside down and smaller.
    let bent = refract(sight.direction, normal, 1.0 / 1.33);
    let shift = (bent - sight.direction) * max(6.0 * corner.disc.w, 0.02);
    let clip = view.clip_from_world * vec4f(place + shift, 1.0);
    let uv = clamp(clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5, vec2f(0.0), vec2f(1.0));
    let seen = textureSampleLevel(behind, behind_sampler, uv, 0.0).rgb;
    let fresnel = mirrored(dot(normal, to_eye), 0.02);
    // Light from the sun gathers on the far side of a drop and leaves the near one darker.
    let lit = 0.82 + 0.3 * dot(normal, -view.sun.xyz) * (1.0 - fresnel);
    let half_way = normalize(view.sun.xyz + to_eye);
    let spark = 3.0 * pow(max(dot(normal, half_way), 0.0), 260.0);
    let colour = seen * lit * (1.0 - fresnel) + surroundings(reflect(sight.direction, normal)) * fresnel;
    return Drawn(vec4f(colour + spark * view.sunlight.rgb, 1.0), depth_at(place));
}
