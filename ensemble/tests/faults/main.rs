//! Faults of folders of parts: other studies, calls at once, kills, damage. Each is tried some times here,
//! and more often for docs/parts.md:
//!
//! ```text
//! cargo test --release -p dalembert-ensemble --features parquet --test faults -- --ignored --nocapture
//! ```
//!
//! A trial is left where the call, or one of them, says that all is well and it is not, or fails and should
//! not. Every trial has a control, in which what is looked for is there.

mod at_once;
mod damage;
mod edited;
mod other_studies;
mod study;
mod trials;

use trials::Trials;

/// Tries of each as an ordinary test.
const TRIES: u32 = 20;

/// A row of the table: what is tried, and by what.
type Row = (&'static str, fn(u32) -> Trials);

const ROWS: [Row; 12] = [
    ("another study's parts are there", other_studies::are_there),
    ("two studies begin at once", at_once::two_studies),
    ("one study begins twice at once, with 250 and 600 members a part", at_once::two_sizes),
    ("one study begins twice at once, to two ends within a part", at_once::two_ends),
    ("three times the same call at once, the third later", at_once::the_same),
    ("three times the same call at once, one of them killed", at_once::one_is_killed),
    ("a bit is flipped, in data or footer", damage::flipped),
    ("a run of bytes is zeroed, or the end cut off", damage::overwritten),
    ("a part is renamed over another, or deleted before the call ends", damage::misplaced),
    ("parts of the model before it was edited are there", edited::are_there),
    ("another study goes on with other members", other_studies::goes_on),
    ("two studies begin at once, each with members of its own", at_once::two_studies_apart),
];

/// Tries one row, and requires that none is left and that the control is seen.
fn try_row(row: usize) {
    let (fault, by) = ROWS[row];
    by(TRIES).require_none_left(fault);
}

#[test]
fn another_study_is_not_found() {
    try_row(0);
}

#[test]
fn of_two_studies_at_once_one_is_refused() {
    try_row(1);
}

#[test]
fn of_two_sizes_at_once_one_is_refused() {
    try_row(2);
}

#[test]
fn no_member_stands_in_two_parts() {
    try_row(3);
}

#[test]
fn the_same_call_at_once_ends_well_each_time() {
    try_row(4);
}

#[test]
fn a_kill_is_felt_by_no_other_call() {
    try_row(5);
}

#[test]
fn a_flipped_bit_is_seen() {
    try_row(6);
}

#[test]
fn lost_bytes_are_seen() {
    try_row(7);
}

#[test]
fn a_part_that_is_another_or_gone_is_seen() {
    try_row(8);
}

#[test]
fn an_edited_model_does_not_find_the_parts_of_the_one_before() {
    try_row(9);
}

#[test]
fn another_study_does_not_go_on() {
    try_row(10);
}

#[test]
fn of_two_studies_of_other_members_one_is_refused() {
    try_row(11);
}

/// No test of its own: a call in a process of its own, which others start.
#[test]
fn child() {
    study::be_child();
}

/// The table of docs/parts.md; `FAULTS_TRIES` times each, 200 unless set.
#[test]
#[ignore = "a study of minutes, which prints a table"]
fn table() {
    let tries = std::env::var("FAULTS_TRIES").map_or(200, |tries| tries.parse().unwrap());
    println!("| fault | tries | left | control | what the calls said |\n|---|--:|--:|--:|---|");
    let rows = ROWS.map(|(fault, by)| {
        let trials = by(tries);
        println!("| {fault} | {trials} |");
        (fault, trials)
    });
    rows.iter().for_each(|(fault, trials)| trials.require_none_left(fault));
}
