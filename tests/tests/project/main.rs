//! What the project says of itself: its pages, its files, how its parts use each other.

mod corrections_page;
mod floors;
mod pages;
mod prose;
mod root;
