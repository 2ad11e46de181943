//! What the project says of itself: messages of the compiler, pages.

mod corrections_page;
mod floors;
mod pages;
mod root;
mod ui;
