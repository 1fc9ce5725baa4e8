mod common;
use corpuscle_record::{FrameFormat, Report};
#[test]
fn sample() {
    let p = std::path::Path::new("/tmp/sample-run");
    let _ = std::fs::remove_dir_all(p);
    let scene = common::scene();
    let terrain = common::terrain(&scene);
    common::write_run(p, &scene, &terrain, FrameFormat::Vtp);
    let t = std::time::Instant::now();
    Report::read(p, &scene, &terrain).unwrap().write().unwrap();
    println!("report in {:?}", t.elapsed());
}
