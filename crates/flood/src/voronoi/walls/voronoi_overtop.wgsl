// Gives each cell beside crests what flows over them.
#import declared
#import compensated_sums
#import voronoi_storage

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.beside_crests {
        return;
    }
    let beside = beside_crests[id.x];
    var column = columns[beside.cell];
    var is_changed = false;
    for (var k = beside.first; k < beside.end; k++) {
        let entry = crest_entries[k];
        let crest = crests[entry / 2u];
        let volume = select(-crest.volume, crest.volume, (entry & 1u) == 1u);
        if volume != 0.0 {
            is_changed = true;
            column.volume = add(column.volume, volume);
            column.momentum += select(-crest.momentum, crest.momentum, volume > 0.0);
        }
    }
    if !is_changed {
        return;
    }
    column.volume = tidy(column.volume);
    if column.volume.x < 0.0 {
        column.volume = vec2f(0.0);
    }
    let area = ground[beside.cell].area;
    column.momentum = bounded_momentum(column.momentum, column.volume.x, area);
    columns[beside.cell] = column;
    water[beside.cell] = water_in(beside.cell, column, area);
}
