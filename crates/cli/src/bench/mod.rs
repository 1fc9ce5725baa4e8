//! `corpuscle bench`.

mod drawn;

use crate::args::{Backend, BenchOptions};
use crate::output::{number, print, print_json};
use crate::processes::processes;
use crate::select::select;
use corpuscle::gpu::Gpu;
use corpuscle_validate::{PassTime, Rate, benches};
use std::process::ExitCode;

/// Measures rates and prints each when it is known.
pub fn bench(options: &BenchOptions, as_json: bool) -> anyhow::Result<ExitCode> {
    let processes = processes()?;
    let gpu = if options.backend == Backend::Gpu { Some(Gpu::open().map_err(corpuscle::Error::from)?) } else { None };
    let with = corpuscle_validate::BenchOptions {
        quick: options.quick,
        passes: options.passes && gpu.is_some(),
        gpu,
        processes,
    };
    let mut rates = Vec::new();
    for bench in select(&benches(), |bench| bench.name, &options.names)? {
        if !bench.is_shared && !with.processes.is_first() {
            continue;
        }
        if with.gpu.is_some() && bench.name.starts_with("gas/") {
            tell!("{} left out: it computes on the CPU only", bench.name);
            continue;
        }
        if with.gpu.is_none() && bench.needs_gpu {
            tell!("{} left out: it needs a GPU", bench.name);
            continue;
        }
        let drawn = match &with.gpu {
            Some(gpu) if options.draw => drawn::drawn(bench.name, gpu, options)?,
            _ => None,
        };
        for rate in (bench.run)(&with).into_iter().chain(drawn) {
            let line = line(&rate);
            if as_json {
                tell!("{}", line.trim_end_matches('\n'));
            } else {
                print(&line)?;
            }
            rates.push(rate);
        }
    }
    if as_json && with.processes.is_first() {
        print_json(&rates)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// A rate as text, with the times of its passes.
fn line(rate: &Rate) -> String {
    let Rate { name, particles, dimensions, threads, rate_unit, .. } = rate;
    let of_each = rate.processes.map(|count| format!("{count} processes with ")).unwrap_or_default();
    let on = rate.device.clone().unwrap_or_else(|| format!("{of_each}{threads} threads"));
    let packing = rate.packing.map(|packing| format!(", packing {packing}")).unwrap_or_default();
    let of_what = match particles {
        0 => on,
        _ => format!(
            "{particles} particles, {dimensions}D{packing}, {on}, {} bytes per particle",
            number(rate.bytes_per_particle)
        ),
    };
    let passes = rate.passes.iter().map(|PassTime { name, times_a_step, seconds_a_step }| {
        format!("    {name:24} {:>11} µs per step  ({} times)\n", number(1e6 * seconds_a_step), number(*times_a_step))
    });
    format!("{name:28} {:>11} {rate_unit}  ({of_what})\n{}", number(rate.rate), passes.collect::<String>())
}
