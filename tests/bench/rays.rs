//! `bench rays`: every walk of the tree meets what the host meets, and its rows say how fast.

use crate::support;
use crate::support::program::Program;
use serde_json::Value;

const HALL: [&str; 5] = ["bench", "rays", "hall:triangles=8000", "--rays", "20000"];

#[test]
fn every_walk_meets_what_the_host_meets() {
    let program = Program::new();
    let ran = program.run(&[&HALL[..], &["--repeat", "2", "--json", "--quiet", "--validate"]].concat()).fine();
    let rows: Vec<Value> = ran.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let walks: Vec<[&str; 3]> =
        rows.iter().map(|row| ["rays", "query", "walk"].map(|key| row[key].as_str().unwrap())).collect();
    let mut of_a_set = vec![["any", "plain"], ["any", "ordered"], ["nearest", "ordered"]];
    // A device without ray queries has no row for them.
    if support::driver().features.ray_query {
        of_a_set.extend([["any", "query"], ["nearest", "query"]]);
    }
    let expected: Vec<[&str; 3]> = ["incoherent", "coherent"]
        .into_iter()
        .flat_map(|rays| of_a_set.iter().map(move |[query, walk]| [rays, *query, *walk]))
        .collect();
    assert_eq!(walks, expected);
    for row in &rows {
        let number = |key: &str| row[key].as_f64().unwrap_or_else(|| panic!("{key}: {row:#}"));
        assert!(number("hits") > 10_000.0 && number("hits") <= 20_000.0, "{row:#}");
        assert!(number("differing") <= 20.0, "{row:#}");
        assert!(number("mrays_per_s") > 0.0 && number("host_mrays_per_s") > 0.0, "{row:#}");
        for ratio in ["speed_to_plain", "speed_to_host"] {
            assert!(row[ratio]["mean"].as_f64().unwrap() > 0.0 && row[ratio]["pairs"] == 2, "{row:#}");
        }
        assert_eq!(row["ms"]["samples"].as_array().unwrap().len(), 2);
        assert_eq!(row["scene"]["name"], "hall:triangles=8000,lights=17,draws=437");
    }
    // The walks of a set meet as much: what is nearest is something.
    for set in rows.chunks(of_a_set.len()) {
        assert_eq!(set[0]["hits"], set[1]["hits"]);
        let [any, nearest] = [0, 2].map(|index| set[index]["hits"].as_f64().unwrap());
        assert!((any - nearest).abs() <= 20.0, "{any} and {nearest}");
    }
}

/// Whatever the nodes are, wherever they lie and wait: the same triangle for each ray, to the bit.
#[test]
fn every_tree_and_stack_meets_the_same() {
    let program = Program::new();
    let sweeps =
        ["node-width=2,4", "node-layout=depth-first,breadth-first,van-emde-boas", "stack=private,shared,short"];
    let mut rows: Vec<Value> = Vec::new();
    // With room for one nearly every turn begins at the root again.
    for entries in ["8", "1"] {
        let mut arguments =
            [&HALL[..], &["--repeat", "1", "--json", "--quiet", "--validate", "--stack-entries", entries]].concat();
        sweeps.iter().for_each(|sweep| arguments.extend(["--sweep", sweep]));
        let ran = program.run(&arguments).fine();
        rows.extend(ran.out.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()));
    }
    // Where the device has ray queries, they walk the driver's own structure.
    rows.retain(|row| row["walk"] != "query");
    assert_eq!(rows.len(), 2 * 2 * (1 + 2 * 18));
    for rays in ["incoherent", "coherent"] {
        for query in ["any", "nearest"] {
            let of: Vec<&Value> = rows.iter().filter(|row| row["rays"] == rays && row["query"] == query).collect();
            for row in &of {
                // Where each shader rounds for itself the hash is of other last bits; both have the host's triangles.
                let is_same = row["hits_hash"] == of[0]["hits_hash"];
                assert!(is_same || !support::driver().identity.is_software(), "{rays} {query}: {row:#}");
                assert!(row["differing"].as_u64().unwrap() <= 20, "{row:#}");
            }
        }
    }
    for row in rows.iter().filter(|row| row["walk"] == "ordered") {
        let [nodes, bytes, entries] = ["nodes", "node_bytes", "stack_entries"].map(|key| row[key].as_u64().unwrap());
        assert_eq!(bytes, nodes * if row["settings"]["node-width"] == "4" { 112 } else { 32 }, "{row:#}");
        assert_eq!(row["stack"], row["settings"]["stack"], "{row:#}");
        let short_entries = row["settings"]["stack-entries"].as_str().and_then(|text| text.parse().ok());
        assert_eq!(row["stack"] == "short", short_entries == Some(entries), "{row:#}");
    }
}

#[test]
fn a_person_reads_a_table() {
    let program = Program::new();
    let out = program.run(&[&HALL[..], &["--repeat", "1", "--seed", "7"]].concat()).fine().out;
    for words in ["incoherent any plain", "coherent nearest ordered", "Mrays/s", "speed to host"] {
        assert!(out.contains(words), "{out}");
    }
}

#[test]
fn what_cannot_be_cast_is_refused() {
    let program = Program::new();
    program.fails(&["bench", "rays", "--rays", "0"], 2, &["--rays"]);
    program.fails(&["bench", "rays", "--sweep", "pattern=2x2"], 2, &["--sweep pattern", "node-width"]);
    program.fails(&["bench", "rays", "--sweep", "node-width=2,3"], 2, &["--node-width 3", "2|4"]);
    program.fails(&["bench", "rays", "missing.glb"], 2, &["missing.glb"]);
    program.fails(&["bench", "rays", "hall:triangles=8000", "--device", "no such thing"], 3, &["no such thing"]);
}
