//! Some random scenes of every model run, and what must hold does.

use corpuscle_fuzz::scenes::{Kind, Trial, scene, try_scene};

#[test]
fn random_scenes_hold_what_they_must() {
    for (name, kind) in Kind::ALL {
        let mut sound = 0;
        for seed in 1..=8 {
            let (text, _) = scene(kind, seed, &[]);
            match try_scene(kind, &text) {
                Trial::Sound(steps) => sound += u64::from(steps > 0),
                Trial::Refused(_) => {}
                Trial::Finding(finding) => panic!("{name} {seed}: {finding:?}\n{text}"),
            }
        }
        assert!(sound >= 3, "{name}: {sound} of 8 scenes ran");
    }
}

#[test]
fn a_seed_makes_one_scene_and_features_can_be_left_out() {
    for (_, kind) in Kind::ALL {
        let (whole, asked) = scene(kind, 5, &[]);
        assert_eq!(whole, scene(kind, 5, &[]).0);
        assert_ne!(whole, scene(kind, 6, &[]).0);
        let all: Vec<usize> = (0..asked).collect();
        assert!(scene(kind, 5, &all).0.len() < whole.len());
    }
}
