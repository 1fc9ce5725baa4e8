//! The device's discs against the CPU's.

use super::super::droplet::Batch;
use super::super::sides::faces;
use super::super::{FluidPainter, FluidStyle, Water};
use super::DeviceWater;
use crate::shared::{DropletInstance, Vertex};
use crate::{Camera, Drawable, HeightField, Light, Renderer, Stage, Target};
use corpuscle_gpu::{DeviceParticle, DeviceParticles, Gpu, Image, read, require_gpu, wait_for};
use corpuscle_model::{Column, ParticleSet, Values};

/// Where all of it lies, m: coordinates are large.
const CORNER: [f64; 3] = [612_000.0, 5_300_000.0, 400.0];
/// Positions and lengths over the stage's half diagonal; normals, parts of foam; depth, part of it.
const NEAR: f32 = 2e-5;
const LIKE: f32 = 2e-3;
/// Mean difference of two pictures, of 255.
const SAME: f64 = 0.02;

/// Height of the ground above the corner, m: it slopes, and is in the north steeper than discs lie.
fn floor(x: f64, y: f64) -> f64 {
    0.05 * x + 1.3 * (y - 38.0).max(0.0)
}

/// Water that runs together over sloping ground, 4000 particles 1 m apart, uneven, on a pile steeper than water can stand, with spray.
fn water(meeting: f64) -> ParticleSet {
    let mut set = ParticleSet { name: "water".into(), ..ParticleSet::default() };
    let mut depths = Vec::new();
    for index in 0..4000_u64 {
        let uneven = |of: u64| (index.wrapping_mul(of) % 97) as f64 / 97.0 - 0.5;
        let at = [(index % 80) as f64 + 0.7 * uneven(31), (index / 80) as f64 + 0.7 * uneven(57)];
        let in_air = index % 250 == 7;
        let pile = if (30.0..33.0).contains(&at[0]) && (20.0..23.0).contains(&at[1]) { 9.0 } else { 0.0 };
        let high = if in_air { 3.0 } else { 1.0 + 0.2 * (0.4 * at[0]).sin() * (0.3 * at[1]).cos() + pile };
        set.id.push(index);
        set.position.push([CORNER[0] + at[0], CORNER[1] + at[1], CORNER[2] + floor(at[0], at[1]) + high]);
        set.velocity.push([if at[0] < 50.0 { meeting } else { -meeting }, 0.3, 0.0]);
        set.radius.push(0.5 + 0.2 * uneven(13));
        set.mass.push(1000.0 * (1.0 + 0.3 * uneven(71)));
        depths.push(if in_air { 0.0 } else { high });
    }
    set.columns = vec![Column { name: "depth", unit: "m", values: Values::Scalar(depths) }];
    set
}

fn ground() -> HeightField {
    let to = [CORNER[0] + 80.0, CORNER[1] + 50.0];
    // Without data in a corner.
    let height = |x: f64, y: f64| {
        if x > to[0] - 10.0 && y > to[1] - 10.0 { f64::NAN } else { CORNER[2] + floor(x - CORNER[0], y - CORNER[1]) }
    };
    HeightField::sampled([CORNER[0], CORNER[1]], to, [41, 26], height)
}

fn stage() -> Stage {
    let [x, y, z] = CORNER;
    Stage::new(CORNER, [x + 80.0, y + 50.0, z + 20.0])
}

/// Room for them and `more` on the device.
fn room(gpu: &Gpu, more: usize) -> DeviceParticles {
    DeviceParticles::new(gpu, 4100 + more, [CORNER[0] + 40.0, CORNER[1] + 25.0, CORNER[2]], 1.0).unwrap()
}

/// Brings particles there, in another order and with some that are none.
fn send(gpu: &Gpu, set: &ParticleSet, particles: &DeviceParticles) {
    let Values::Scalar(depths) = &set.columns[0].values else { panic!("depths are numbers") };
    let mut sent = vec![DeviceParticle::default(); 9];
    sent.extend((0..set.len()).rev().map(|index| DeviceParticle {
        position: [0, 1, 2].map(|axis| (set.position[index][axis] - particles.origin[axis]) as f32),
        spacing: 2.0 * set.radius[index] as f32,
        velocity: set.velocity[index].map(|along| along as f32),
        depth: depths[index] as f32,
        volume: (set.mass[index] / 1000.0) as f32,
        id: set.id[index] as u32,
        ..DeviceParticle::default()
    }));
    particles.write(gpu, &sent);
}

/// What is drawn, by ids.
fn drawn(gpu: &Gpu, water: &DeviceWater) -> Vec<DropletInstance> {
    let Some(Batch::Indirect { instances, draw_args, at, .. }) = water.droplets() else { panic!("nothing is drawn") };
    let draw_args: Vec<u32> = wait_for(read(gpu, &draw_args, at as usize / 4 + 4)).unwrap();
    let [corners, count, ..] = draw_args[at as usize / 4..] else { panic!("there are no arguments of a draw") };
    assert_eq!(corners, 4);
    let mut all: Vec<DropletInstance> = wait_for(read(gpu, &instances, count as usize)).unwrap();
    all.sort_by(|a, b| a.matter[3].total_cmp(&b.matter[3]));
    all
}

/// What the CPU draws, by ids.
fn by_cpu(water: &mut Water, time: f64, set: &ParticleSet, field: &HeightField) -> Vec<DropletInstance> {
    let mut droplets = water.droplets(time, set, |position| field.slope_at(position));
    droplets.sort_by_key(|droplet| droplet.id);
    droplets.iter().filter_map(|droplet| droplet.drawn(&stage())).collect()
}

fn compare(device: &[DropletInstance], host: &[DropletInstance]) {
    assert_eq!(device.len(), host.len());
    let apart =
        |one: &[f32], other: &[f32]| one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f32::max);
    for (one, other) in device.iter().zip(host) {
        assert!(apart(&one.position, &other.position) < NEAR, "{one:?} {other:?}");
        assert!((one.radius - other.radius).abs() < NEAR, "{one:?} {other:?}");
        assert!((one.flatness - other.flatness).abs() < LIKE, "{one:?} {other:?}");
        assert!(apart(&one.normal, &other.normal) < LIKE, "{one:?} {other:?}");
        assert!(apart(&one.matter[1..2], &other.matter[1..2]) < LIKE, "{one:?} {other:?}");
        assert!((one.matter[0] - other.matter[0]).abs() <= 1e-5 * other.matter[0], "{one:?} {other:?}");
        assert!(apart(&one.matter[2..], &other.matter[2..]) < NEAR, "{one:?} {other:?}");
        assert!(apart(&one.flow, &other.flow) < LIKE, "{one:?} {other:?}");
    }
}

#[test]
fn the_device_makes_the_discs_that_the_cpu_makes() {
    let Some(gpu) = require_gpu("discs on the device") else { return };
    let field = ground();
    let (mut device, mut host) = (DeviceWater::new(&gpu, &stage(), &field, 1.0).unwrap(), Water::default());
    // The foam of where water has met is left when it parts, and when room is made for more particles.
    for (time, meeting, more) in [(10.0, 3.5, 0), (10.5, -3.5, 100), (11.5, 0.0, 20_000)] {
        let (set, particles) = (water(meeting), room(&gpu, more));
        send(&gpu, &set, &particles);
        device.update(&gpu, time, &particles).unwrap();
        let host = by_cpu(&mut host, time, &set, &field);
        let foam = host.iter().filter(|instance| instance.matter[1] > 0.2).count();
        assert!(foam > 20, "{foam} at {time} s");
        compare(&drawn(&gpu, &device), &host);
    }
}

#[test]
fn the_water_at_the_borders_has_the_faces_that_the_cpu_finds() {
    let Some(gpu) = require_gpu("sides of water on the device") else { return };
    let (field, set) = (ground(), water(0.0));
    let mut device = DeviceWater::new(&gpu, &stage(), &field, 1.0).unwrap();
    let particles = room(&gpu, 0);
    send(&gpu, &set, &particles);
    device.update(&gpu, 0.0, &particles).unwrap();
    let (buffer, count) = device.faces().unwrap();
    let found: Vec<Vertex> = wait_for(read(&gpu, &buffer, count as usize)).unwrap();
    let found: Vec<&[Vertex]> = found.chunks(6).filter(|face| face[0].position != face[1].position).collect();
    let droplets = Water::default().droplets(0.0, &set, |position| field.slope_at(position));
    let wanted = faces(&stage(), &field, &droplets);
    // Ten of 130 lie in the corner without data.
    assert!(found.len() > 110 && wanted.len() == 6 * found.len(), "{} {}", found.len(), wanted.len());
    for (one, other) in found.concat().iter().zip(&wanted) {
        assert_eq!(one.normal, other.normal);
        let apart =
            one.position.iter().zip(&other.position).map(|(one, other)| (one - other).abs()).fold(0.0, f32::max);
        assert!(apart < NEAR, "{one:?} {other:?}");
    }
}

fn picture(gpu: &Gpu, fill: impl FnOnce(&mut crate::Fluid)) -> Image {
    let renderer = Renderer::new(gpu);
    let mut fluid = FluidPainter::new(&renderer).fluid(gpu, &stage(), FluidStyle::water(0.5)).unwrap();
    fill(&mut fluid);
    let target = Target::new(gpu, [320, 200], 1).unwrap();
    let camera = Camera::orbit(&stage(), [-1.2, 0.6], 0.6, 1.6, 0.0);
    let things: &mut [&mut dyn Drawable] = &mut [&mut fluid];
    renderer.draw(&target, &stage(), &camera, &Light::day(), things, None);
    renderer.read(&target).unwrap()
}

#[test]
fn a_picture_is_the_same_from_the_device() {
    let Some(gpu) = require_gpu("a picture from the device") else { return };
    let (field, set) = (ground(), water(3.5));
    let mut device = DeviceWater::new(&gpu, &stage(), &field, 1.0).unwrap();
    let particles = room(&gpu, 0);
    send(&gpu, &set, &particles);
    device.update(&gpu, 0.0, &particles).unwrap();
    let one = picture(&gpu, |fluid| fluid.draw_from(&device));
    let droplets = Water::default().droplets(0.0, &set, |position| field.slope_at(position));
    let other = picture(&gpu, |fluid| fluid.fill(&gpu, droplets));
    let nothing = picture(&gpu, |_| ());
    let difference = |one: &Image, other: &Image| {
        let sum: u64 = one.rgba.iter().zip(&other.rgba).map(|(one, other)| u64::from(one.abs_diff(*other))).sum();
        sum as f64 / one.rgba.len() as f64
    };
    let apart = difference(&one, &other);
    println!("{apart} of 255");
    assert!(apart < SAME, "{apart}");
    assert!(difference(&one, &nothing) > 5.0);
}
