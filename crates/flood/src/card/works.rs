//! Zones, structures and tables as the shaders have them: one list of numbers, as `flood_places.wgsl`, `flood_births.wgsl` and
//! `flood_regulate.wgsl` tell.

use super::layout::Origin;
use crate::edges::EdgeRule;
use crate::hydraulics::Law;
use crate::infiltration::MM_PER_H;
use crate::inflow::Source;
use crate::scheme::Surroundings;
use crate::structures::{Flow, Flows, Structures};
use crate::zone::Zone;
use corpuscle_gpu::{Gpu, GpuError, read, storage, wgpu};
use corpuscle_scene::Table;

/// Numbers before all others.
const HEADER: usize = 16;

/// Where the header says what.
const FIRSTS: usize = 3;
const FLOWS: usize = 6;
const STRIPS: usize = 8;
const LEVELS: usize = 12;

/// Numbers that a flow and a link take.
const FLOW: usize = 4;
const LINK: usize = 16;

/// Rows of a table that the card knows at a time.
const WINDOW: usize = 64;

/// A table over time, of which the card knows the next rows.
#[derive(Debug)]
struct Window {
    /// Where it stands among the numbers.
    at: usize,
    table: Table,
    /// What is taken off each value, and what it is multiplied by.
    less: f64,
    times: f64,
}

/// Everything that water comes from and goes to.
#[derive(Debug)]
pub(super) struct Works {
    pub buffer: wgpu::Buffer,
    /// The zone of each source.
    pub sources: Vec<u32>,
    /// Where the rows of the rain are told; 0 where it does not rain.
    pub rain: u32,
    pub has_structures: bool,
    pub holds_level: bool,
    windows: Vec<Window>,
    flows: usize,
}

impl Works {
    /// With strips beyond held sides for particles whose smoothing length is `h` m.
    pub fn new(
        gpu: &Gpu,
        surroundings: &Surroundings,
        sources: &[Source],
        structures: &Structures,
        rain: Option<&Table>,
        origin: Origin,
        h: f64,
    ) -> Result<Self, GpuError> {
        let flows = structures.outflows.len() + structures.links.len();
        let numbers = vec![0; HEADER + FLOW * flows];
        let mut list = List { numbers, windows: Vec::new(), surroundings, origin };
        list.numbers[FLOWS] = HEADER as u32;
        let sources = sources.iter().map(|source| list.zone(&source.zone)).collect();
        list.sides(h);
        list.structures(structures);
        let rain = rain.map_or(0, |intensity| list.window(intensity, 0.0, MM_PER_H));
        let List { numbers, windows, .. } = list;
        let buffer = storage::<u32>(gpu, "zones and structures", numbers.len())?;
        gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&numbers));
        let (has_structures, holds_level) = (!structures.is_empty(), surroundings.edges.holds_level());
        Ok(Self { buffer, sources, rain, has_structures, holds_level, windows, flows })
    }

    /// Outflows and links.
    pub fn flow_count(&self) -> usize {
        self.flows
    }

    /// Says what outflows and links owe.
    pub fn begin(&self, gpu: &Gpu, flows: &Flows) {
        let rows: Vec<[f32; FLOW]> = (flows.outflows.iter().chain(&flows.links))
            .map(|flow| {
                let sum = flow.owed as f32;
                [sum, (f64::from(sum) - flow.owed) as f32, flow.discharge as f32, 0.0]
            })
            .collect();
        gpu.queue.write_buffer(&self.buffer, 4 * HEADER as u64, bytemuck::cast_slice(&rows));
    }

    /// What outflows and links owe and lead.
    pub fn flows(&self, gpu: &Gpu, flows: &mut Flows) -> Result<(), GpuError> {
        if self.flows == 0 {
            return Ok(());
        }
        let numbers: Vec<f32> = read(gpu, &self.buffer, HEADER + FLOW * self.flows)?;
        let rows = numbers[HEADER..].chunks_exact(FLOW);
        for (flow, row) in flows.outflows.iter_mut().chain(&mut flows.links).zip(rows) {
            *flow = Flow { owed: f64::from(row[0]) - f64::from(row[1]), discharge: f64::from(row[2]) };
        }
        Ok(())
    }

    /// Tells of what tables say from `since` s before the time `now`, s, to `horizon` s after it.
    pub fn tell(&self, gpu: &Gpu, now: f64, since: f64, horizon: f64) {
        for Window { at, table, less, times } in &self.windows {
            let rows = window(table, now - since, since + horizon);
            let mut numbers = vec![rows.len() as u32];
            numbers.extend(rows.iter().flat_map(|[time, value]| {
                [time - since, times * (value - less)].map(|number| (number as f32).to_bits())
            }));
            gpu.queue.write_buffer(&self.buffer, 4 * *at as u64, bytemuck::cast_slice(&numbers));
        }
    }
}

/// The rows of a table within `horizon` s, times from `now`; of too many some.
pub(super) fn window(table: &Table, now: f64, horizon: f64) -> Vec<[f64; 2]> {
    let rows = table.rows();
    let inside = rows.partition_point(|row| row[0] <= now)..rows.partition_point(|row| row[0] < now + horizon);
    let every = inside.len().div_ceil(WINDOW - 2).max(1);
    let between = rows[inside].iter().step_by(every).map(|row| [row[0] - now, row[1]]);
    let ends = [0.0, horizon].map(|time| [time, table.at(now + time)]);
    std::iter::once(ends[0]).chain(between).chain([ends[1]]).collect()
}

struct List<'a> {
    numbers: Vec<u32>,
    windows: Vec<Window>,
    surroundings: &'a Surroundings,
    origin: Origin,
}

impl List<'_> {
    fn end(&self) -> u32 {
        self.numbers.len() as u32
    }

    fn push(&mut self, values: &[f64]) {
        self.numbers.extend(values.iter().map(|value| (*value as f32).to_bits()));
    }

    fn places(&mut self, places: &[[f64; 2]]) -> [u32; 2] {
        let first = self.end();
        let origin = self.origin;
        self.numbers.extend(places.iter().flat_map(|place| origin.relative(*place).map(f32::to_bits)));
        [first, places.len() as u32]
    }

    fn zone(&mut self, zone: &Zone) -> u32 {
        let (kind, corners, width): (u32, &[[f64; 2]], f64) = match zone {
            Zone::Disc { radius, .. } => (0, &[], *radius),
            Zone::Band { line, half_width } => (1, line, *half_width),
            Zone::Polygon(corners) => (2, corners, 0.0),
        };
        let [first, count] = self.places(corners);
        let looks = zone.looks();
        let first_look = self.end();
        for look in &looks {
            let in_obstacle = f64::from(u8::from(self.surroundings.obstacles.hold(*look)));
            let [x, y] = self.origin.relative(*look).map(f64::from);
            self.push(&[x, y, in_obstacle]);
        }
        let (middle, reach) = zone.round();
        let length: f64 = corners.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum();
        let along = |pick: fn(f64, f64) -> f64, none: f64| {
            [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).fold(none, pick))
        };
        let at = self.end();
        self.numbers.extend([kind, first, count]);
        let [x, y] = self.origin.relative(middle).map(f64::from);
        self.push(&[width, x, y, reach, zone.area()]);
        self.numbers.extend([first_look, looks.len() as u32]);
        self.push(&[length]);
        if kind == 2 {
            let (low, high) = (along(f64::min, f64::INFINITY), along(f64::max, f64::NEG_INFINITY));
            let [x, y] = self.origin.relative(low).map(f64::from);
            self.push(&[x, y, high[0] - low[0], high[1] - low[1]]);
        } else {
            self.push(&[0.0; 4]);
        }
        at
    }

    fn table(&mut self, rows: &[[f64; 2]], less: [f64; 2]) -> [u32; 2] {
        let first = self.end();
        rows.iter().for_each(|row| self.push(&[row[0] - less[0], row[1] - less[1]]));
        [first, rows.len() as u32]
    }

    fn window(&mut self, table: &Table, less: f64, times: f64) -> u32 {
        let at = self.end();
        self.windows.push(Window { at: at as usize, table: table.clone(), less, times });
        self.numbers.resize(self.numbers.len() + 1 + 2 * WINDOW, 0);
        at
    }

    /// Sides held at levels: the pieces of their strips, and their levels.
    fn sides(&mut self, h: f64) {
        let edges = &self.surroundings.edges;
        let [width, height] = edges.bounds.size();
        for (side, length) in [height, height, width, width].into_iter().enumerate() {
            if let EdgeRule::Stage(level) = &edges.rules[side] {
                self.numbers[STRIPS + side] = (length / (3.0 * h)).ceil().max(1.0) as u32;
                self.numbers[LEVELS + side] = self.window(level, self.origin.level, 1.0);
            }
        }
    }

    fn structures(&mut self, structures: &Structures) {
        let Structures { outflows, held, links } = structures;
        let level = self.origin.level;
        let mut records = [Vec::new(), Vec::new(), Vec::new()];
        for outflow in outflows {
            let zone = self.zone(&outflow.zone);
            let [first, rows] = self.table(outflow.rating.rows(), [level, 0.0]);
            records[0].extend([zone, first, rows]);
        }
        for held in held {
            let zone = self.zone(&held.zone);
            records[1].extend([zone, self.window(&held.level, level, 1.0)]);
        }
        for link in links {
            let ends = [0, 1].map(|end| self.zone(&link.ends[end]));
            let mut record = vec![ends[0], ends[1], u32::from(link.both_ways)];
            record.extend(self.law(&link.law));
            record.resize(LINK, 0);
            records[2].extend(record);
        }
        for (kind, (record, count)) in records.iter().zip([outflows.len(), held.len(), links.len()]).enumerate() {
            self.numbers[kind] = count as u32;
            self.numbers[FIRSTS + kind] = self.end();
            self.numbers.extend(record);
        }
    }

    fn law(&mut self, law: &Law) -> Vec<u32> {
        let level = self.origin.level;
        let numbers = |kind: u32, values: &[f64]| {
            std::iter::once(kind).chain(values.iter().map(|value| (*value as f32).to_bits())).collect()
        };
        match law {
            Law::Culvert(culvert) => numbers(0, &culvert.numbers(level)),
            Law::Weir(weir) => numbers(1, &[weir.crest_m - level, weir.width_m, weir.coefficient]),
            Law::Rating(table) => {
                let [first, rows] = self.table(table.rows(), [0.0; 2]);
                vec![2, first, rows]
            }
        }
    }
}
