// Plans of groups of cells, added up.
#import declared
#import group_reduction

alias Reduced = Plan;

fn combine(a: Plan, b: Plan) -> Plan {
    return Plan(max(a.highest, b.highest), a.wet + b.wet, a.quarters + b.quarters);
}
