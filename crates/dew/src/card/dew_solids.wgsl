// Solids: their particles, and what they exchange with the air.
#import dew_card

// A particle of a solid, its image, or a ghost sample.
struct Site {
    place: vec3f,
    // Over that of a parcel.
    volume: f32,
    // Conductivities with which the air is warmed and the solid, W/(m K).
    to_air: f32,
    to_solid: f32,
    // Part of the heat at the surface that goes to the solid.
    part: f32,
    flags: u32,
    particle: u32,
    // Its pairs in the list of conductances.
    first: u32,
    end: u32,
    // J/K.
    capacity: f32,
}

// Flags of sites.
const BOUNDARY = 1u;
const NEAR_SURFACE = 2u;
const JOINS_DENSITY = 4u;
const REPELS = 8u;
const GHOST = 16u;
const HELD = 32u;
// An image beyond a side that air passes.
const IMAGE_BEYOND = 64u;

// Water on a solid's particle when the host last told, and gained since, kg.
struct Water {
    told: f32,
    // Part of the evaporation of a wet surface that it lets go.
    evaporation: f32,
    gained: Account,
}

// What else changes of a solid's particle; its temperature is counted from the ambient air's, K.
struct Solid {
    temperature: Account,
    // Heat through the surface, W, and heat that it was held against, J, in the last step; how stiff diffusion was, 1/s.
    flow: f32,
    held: f32,
    stiff: f32,
    // Water that the air gave, kg.
    water: f32,
}

// What air sees of a solid's particle in a step, and what it gets.
struct Surface {
    temperature: f32,
    water: f32,
    // Part of the evaporation asked for that there is water for.
    share: f32,
    // Heat from the air, W, and with that through the solid, W; water, kg/s; conductances to air and within, W/K.
    heat: f32,
    all_heat: f32,
    gain: f32,
    conductance: f32,
    // As of `Water`.
    evaporation: f32,
}

// A solid: its particles, what they sum up to, W, 1/s and J, and its rows where the temperature it is held at changes.
struct Body {
    first: u32,
    end: u32,
    flow: f32,
    stiff: f32,
    held: Account,
    first_row: u32,
    end_row: u32,
    // kg.
    water: f32,
    unused: f32,
}
