// Evaluates all tables for the next step.
#import declared
#import compensated_sums
#import voronoi_tables

fn look_up(table: u32) {
    let header = TABLE * table;
    let sum = integral(table, status.clock, status.step);
    tables[header + INTEGRAL] = bitcast<u32>(sum);
    tables[header + MEAN] = bitcast<u32>(sum / status.step);
    tables[header + AT_BEGINNING] = bitcast<u32>(value_at(table, status.clock));
    tables[header + AT_BEGINNING + 1u] = bitcast<u32>(value_at(table, add(status.clock, status.step)));
}

fn look_up_all() {
    for (var table = 0u; table < parameters.tables; table++) {
        look_up(table);
    }
}
