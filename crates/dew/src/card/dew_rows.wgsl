// Values over time. Twin of `Table::at`.
#import dew_card

// From one time to another, s.
fn between(a: Account, b: Account) -> f32 {
    return (b.sum - a.sum) - (b.lacking - a.lacking);
}

// The value at a time, by rows of which there is one at least; at a jump the one after it.
fn value_at(first: u32, end: u32, time: Account) -> f32 {
    var value = rows[first].value;
    for (var k = first; k < end; k++) {
        let since = between(rows[k].time, time);
        if since < 0.0 {
            break;
        }
        value = rows[k].value;
        if k + 1u < end {
            let whole = between(rows[k].time, rows[k + 1u].time);
            let part = select(1.0, min(since / whole, 1.0), whole > 0.0);
            value += part * (rows[k + 1u].value - value);
        }
    }
    return value;
}
