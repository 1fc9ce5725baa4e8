// Values over time. Twin of `Table::at`.
#import dew_particles

// The value at a time, by rows of which there is one at least; at a jump the one after it.
fn value_at(first: u32, end: u32, time: vec2f) -> f32 {
    var value = rows[first].value;
    for (var k = first; k < end; k++) {
        let since = difference(time, rows[k].time);
        if since < 0.0 {
            break;
        }
        value = rows[k].value;
        if k + 1u < end {
            let whole = difference(rows[k + 1u].time, rows[k].time);
            let part = select(1.0, min(since / whole, 1.0), whole > 0.0);
            value += part * (rows[k + 1u].value - value);
        }
    }
    return value;
}
