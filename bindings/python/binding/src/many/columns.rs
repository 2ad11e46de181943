//! Columns of files for the fields that differ from member to member.

use dalembert_face::{Fields, Number};

use super::Asked;

/// A column: an entry of a field.
pub struct Column {
    /// Its name.
    pub name: String,
    /// Which field.
    pub field: usize,
    /// Which of its numbers, row by row.
    pub index: usize,
}

/// A column for each entry of the fields that differ: named as the field, `c0` and `c1` of an array, `m0_1`
/// of one with two dimensions, `drag_x0` and `drag_y0` of a table; after `field_` where other columns of the
/// file may have that name.
pub fn columns<F: Fields>(asked: &Asked<'_>, coordinates: usize) -> Vec<Column> {
    let mut taken: Vec<String> = ["member", "t", "energy", "event", "error"].map(str::to_owned).into();
    taken.extend(['q', 'p'].iter().flat_map(|symbol| (0..coordinates).map(move |i| format!("{symbol}{i}"))));
    let mut columns: Vec<Column> = Vec::new();
    for &(field, _) in asked.fields {
        let about = &F::FIELDS[field];
        for index in 0..about.dimensions.iter().product() {
            let mut name = match *about.dimensions {
                [_, points] if about.is_table => {
                    format!("{}_{}{}", about.name, ["x", "y"][index / points], index % points)
                }
                [] => about.name.to_owned(),
                [_, columns] => format!("{}{}_{}", about.name, index / columns, index % columns),
                _ => format!("{}{index}", about.name),
            };
            while taken.contains(&name) {
                name.insert_str(0, "field_");
            }
            taken.push(name.clone());
            columns.push(Column { name, field, index });
        }
    }
    columns
}

/// A number as columns have it.
pub fn in_column(number: Number) -> f64 {
    match number {
        Number::F64(value) => value,
        Number::F32(value) => value.into(),
        Number::I8(value) => value.into(),
        Number::I16(value) => value.into(),
        Number::I32(value) => value.into(),
        Number::I64(value) => value as f64,
        Number::U8(value) => value.into(),
        Number::U16(value) => value.into(),
        Number::U32(value) => value.into(),
        Number::U64(value) => value as f64,
    }
}
