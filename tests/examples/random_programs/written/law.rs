//! Laws as enums, options, and arrays of structs.

use super::draft::Draft;
use super::manner::Manner;

impl Draft {
    /// A law of the model, one of several.
    pub fn law(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        self.used.insert(Manner::Laws);
        let scalar = self.scalar;
        let ty = self.type_name(&["Law", "Friction", "Spring"]);
        self.items.push(format!(
            "#[derive(Clone, Copy, PartialEq)]\npub enum {ty} {{\n    None,\n    Linear {{ k: {scalar} }},\n    Cubic {{ k: {scalar}, c: {scalar} }},\n    Stepped({scalar}, u8),\n}}"
        ));
        let (k, c) = (self.number(0.5, 3.0), self.number(0.1, 1.0));
        let value = match self.random.below(4) {
            0 => format!("{ty}::None"),
            1 => format!("{ty}::Linear {{ k: {k} }}"),
            2 => format!("{ty}::Cubic {{ k: {k}, c: {c} }}"),
            _ => format!("{ty}::Stepped({k}, 2)"),
        };
        let field = self.field(&["law", "friction", "kind"], &ty, &value);
        let (k, c, power) = (self.local(), self.local(), self.local());
        let with = |member: &str, local: &str| {
            if member == local { member.to_owned() } else { format!("{member}: {local}") }
        };
        match self.random.below(3) {
            0 => format!(
                "(match self.{field} {{\n    {ty}::None => 0.0,\n    {ty}::Linear {{ {} }} => 0.5 * {k} * ({x}) * ({x}),\n    \
                 {ty}::Cubic {{ {}, {} }} => 0.5 * {k} * ({x}).powi(2) + {c} * ({x}).powi(4),\n    {ty}::Stepped({k}, {power}) if {power} > 1 => {k} * ({x}).sin(),\n    {ty}::Stepped(..) => ({x}) * 0.5,\n}})",
                with("k", &k),
                with("k", &k),
                with("c", &c)
            ),
            1 => {
                lines.push(format!("let mut {power}: {scalar} = 0.0;"));
                lines.push(format!(
                    "if let {ty}::Linear {{ {} }} | {ty}::Cubic {{ {}, .. }} = self.{field} {{\n    {power} += {k} * ({x}).powi(2);\n}}",
                    with("k", &k),
                    with("k", &k)
                ));
                power
            }
            _ => {
                let third = self.number(0.1, 0.5);
                format!(
                    "(if self.{field} == {ty}::None {{ {third} * ({x}) }} else if matches!(self.{field}, {ty}::Stepped(..)) {{ ({x}).cos() }} else {{ ({x}).powi(2) }})"
                )
            }
        }
    }

    /// A stop that the model may have.
    pub fn stop(&mut self, x: &str) -> String {
        self.used.insert(Manner::Options);
        let scalar = self.scalar;
        let value = self.number(0.5, 4.0);
        let value = if self.random.chance(70) { format!("Some({value})") } else { "None".to_owned() };
        let field = self.field(&["stop", "extra", "k3"], &format!("Option<{scalar}>"), &value);
        let k = self.local();
        match self.random.below(4) {
            0 => format!("self.{field}.map_or(0.0, |{k}| {k} * ({x}).powi(2))"),
            1 => format!("(self.{field}.unwrap_or(0.25) * ({x}).sin())"),
            2 => {
                format!("(if let Some({k}) = self.{field} {{ {k} * ({x}) * ({x}) }} else {{ ({x}).cos() }})")
            }
            _ => {
                let helper = self.item(&["stopped", "bumper"]);
                let otherwise = self.quantity(0.0, 1.0);
                self.block.push(format!(
                    "fn {helper}(&self, x: {scalar}) -> {scalar} {{\nlet Some({k}) = self.{field} else {{ return {otherwise} * x; }};\n0.5 * {k} * x * x\n}}"
                ));
                format!("self.{helper}({x})")
            }
        }
    }

    /// Springs at several places.
    pub fn springs(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        self.used.insert(Manner::StructArrays);
        let ty = self.shared(Manner::StructArrays, &["Spring", "Node", "Wheelset"], |name, scalar| {
            format!("#[derive(Clone, Copy)]\npub struct {name} {{\n    pub k: {scalar},\n    pub at: {scalar},\n}}")
        });
        let scalar = self.scalar;
        let one = |draft: &mut Self| {
            format!("{ty} {{ k: {}, at: {} }}", draft.number(0.3, 2.0), draft.number(-1.0, 1.0))
        };
        let entries = format!("[{}, {}]", one(self), one(self));
        let array = match self.random.below(3) {
            0 => {
                let name = self.constant();
                self.items.push(format!("pub const {name}: [{ty}; 2] = {entries};"));
                name
            }
            _ => format!("self.{}", self.field(&["springs", "nodes", "k"], &format!("[{ty}; 2]"), &entries)),
        };
        let (spring, sum) = (self.local(), self.local());
        match self.random.below(4) {
            0 => {
                lines.push(format!("let {sum}: [{ty}; 2] = {array};"));
                format!(
                    "{sum}.iter().map(|{spring}| 0.5 * {spring}.k * (({x}) - {spring}.at).powi(2)).sum::<{scalar}>()"
                )
            }
            1 => {
                lines.push(format!("let mut {sum}: {scalar} = 0.0;"));
                let all = self.local();
                lines.push(format!("let {all}: [{ty}; 2] = {array};\nfor {spring} in &{all} {{\n    {sum} += {spring}.k * ({x} - {spring}.at).cos();\n}}"));
                sum
            }
            2 => {
                lines.push(format!("let mut {sum}: {scalar} = 0.0;"));
                lines.push(format!(
                    "for i in 0..2 {{\n    let {spring} = {array}[i].k;\n    {sum} += {spring} * ({x} - {array}[i].at).powi(2);\n}}"
                ));
                sum
            }
            _ => {
                let at = self.local();
                lines.push(format!("let {ty} {{ k: {spring}, at: {at} }} = {array}[1];"));
                format!("({spring} * (({x}) - {at}).powi(2))")
            }
        }
    }
}
