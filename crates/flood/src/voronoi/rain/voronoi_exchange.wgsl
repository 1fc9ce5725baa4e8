// Sources, rain and infiltration of a cell. See `patch.rs` and `rain/mod.rs`.
#import declared
#import compensated_sums
#import voronoi_tables
#import voronoi_change
#import infiltration_laws

// Sources bring water with their velocity.
fn supply(cell: u32, column: ptr<function, Column>, own: ptr<function, Found>) {
    for (var word = supplies[cell].first_source; word < supplies[cell].end_source; word += SOURCE) {
        let volume = opaque(in_step(tables[word], INTEGRAL) * number(word + 1u));
        let momentum = volume * vec2f(number(word + 2u), number(word + 3u));
        (*column).volume = add((*column).volume, volume);
        (*column).momentum += momentum;
        (*own).supplied = add((*own).supplied, volume);
        (*own).momentum += momentum.x + momentum.y;
    }
}

fn rain(cell: u32, column: ptr<function, Column>, own: ptr<function, Found>) {
    if parameters.rain_table != NONE {
        let volume = opaque(in_step(parameters.rain_table, INTEGRAL) * supplies[cell].rain_area);
        (*column).volume = add((*column).volume, volume);
        (*own).rained = vec2f(volume, 0.0);
    }
}

// The ground drinks once in some steps: its laws hold for any step of time.
fn drink(cell: u32, column: ptr<function, Column>, own: ptr<function, Found>) {
    let held = (*column).volume.x;
    let at = supplies[cell].law;
    if at == NONE || held <= 0.0 || (status.all_steps + 1u) % STEPS_A_DRAUGHT != 0u {
        return;
    }
    let law = vec4f(number(at), number(at + 1u), number(at + 2u), number(at + 3u));
    let wanted = ground[cell].area * demand(law, supplies[cell].soaked, status.since_draught + status.step);
    let part = min(wanted / held, 1.0);
    // All of it to the last bit, or a part.
    let volume = select(vec2f(opaque(part * held), 0.0), (*column).volume, part == 1.0);
    let momentum = part * (*column).momentum;
    (*column).volume = add_pair((*column).volume, -volume);
    (*column).momentum -= momentum;
    supplies[cell].soaked += volume.x / ground[cell].area;
    (*own).infiltrated = volume;
    (*own).momentum -= momentum.x + momentum.y;
}

fn exchange(cell: u32, own: ptr<function, Found>) {
    let before = columns[cell];
    let area = ground[cell].area;
    var column = before;
    supply(cell, &column, own);
    rain(cell, &column, own);
    drink(cell, &column, own);
    let gained = (column.volume.x - before.volume.x) + (column.volume.y - before.volume.y);
    if gained == 0.0 && all(column.momentum == before.momentum) {
        return;
    }
    column.volume = tidy(column.volume);
    (*own).energy = energy_gained(cell, before, column, area, ground[cell].bed);
    let bounded = bounded_momentum(column.momentum, column.volume.x, area);
    // What a thin film cannot carry counts as taken.
    (*own).momentum += (bounded.x - column.momentum.x) + (bounded.y - column.momentum.y);
    column.momentum = bounded;
    columns[cell] = column;
    water[cell] = water_in(cell, column, area);
}
