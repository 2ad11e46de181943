//! What the project says of itself: its pages, its files, how its parts use each other.

mod circles;
mod compiled;
mod corrections_page;
mod floors;
mod pages;
mod paths;
mod prose;
mod root;
