//! What the project says of itself: messages of the compiler, pages.

mod corrections_page;
mod pages;
mod ui;
