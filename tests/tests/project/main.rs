//! What the project says of itself: its pages, its files, how its parts use each other.

mod corrections_page;
mod floors;
mod long_tests;
mod pages;
mod root;
