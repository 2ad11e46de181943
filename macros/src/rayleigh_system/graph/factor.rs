//! Derivatives in fewer operations: within what is used once, common factors stand once and constants meet.
//!
//! ```text
//! 2 ((½ m) v)            m v
//! x a h + x b h          x (a + b) h, as far as a, b, h are used nowhere else
//! 2 (½ + ½ β s) d        (1 + β s) d
//! ```
//!
//! Works on the expressions of one function, whose uses it counts: what is used more than once stays one
//! expression, and what the user wrote is not touched. Products put first what does not change with q and v,
//! so that it is the same expression, computed once, wherever it occurs.

use std::collections::{HashMap, HashSet};

use super::algebra::exact;
use super::{Graph, Node, Operation};

/// How many sums and products deep a sum is taken apart, and how many factors of a product are looked at.
const DEEPEST: u32 = 128;

/// A product: a constant and what it multiplies.
#[derive(Clone, Debug)]
struct Term {
    coefficient: f64,
    factors: Vec<Node>,
}

impl Term {
    fn constant(coefficient: f64) -> Self {
        Self { coefficient, factors: Vec::new() }
    }

    /// Multiplies by a constant, if the result is exact.
    fn scale(&mut self, factor: f64) -> bool {
        match exact(self.coefficient * factor, &[self.coefficient, factor]) {
            Some(product) => {
                self.coefficient = product;
                true
            }
            None => false,
        }
    }

    /// Whether a multiplication by the constant is left in it.
    fn is_scaled(&self) -> bool {
        !self.factors.is_empty() && self.coefficient.abs() != 1.0
    }
}

/// The rewriting of one function's expressions.
struct Factoring<'g> {
    graph: &'g mut Graph,
    /// Nodes that stay as they are: the first ones, and those that conditions are made of.
    kept: HashSet<Node>,
    /// Sums and products used once, by another sum or product: part of it.
    open: HashSet<Node>,
    /// The node that each node has become, unless it is open.
    rewritten: HashMap<Node, Node>,
    /// Products that the function computes.
    products: HashSet<Node>,
}

impl Graph {
    /// Rewrites `outputs` in fewer operations. The first `written` nodes of the graph stay as they are, and
    /// so do those that conditions are made of: they have to choose as the user's function does.
    pub fn factored(&mut self, outputs: &[Node], written: usize) -> Vec<Node> {
        let nodes = self.reachable(outputs.iter().copied());
        let mut uses: HashMap<Node, u32> = HashMap::new();
        for &node in &nodes {
            self.operation(node).arguments().for_each(|argument| *uses.entry(argument).or_default() += 1);
        }
        outputs.iter().for_each(|&output| *uses.entry(output).or_default() += 1);
        let kept = self.kept(&nodes, written);
        let mut open: HashMap<Node, u32> = HashMap::new();
        for &node in nodes.iter().rev() {
            let depth = open.get(&node).copied();
            if self.is_sum_or_product(node)
                && (!kept.contains(&node) || depth.is_some())
                && depth.is_none_or(|depth| depth < DEEPEST)
            {
                let parts = self.operation(node).arguments().filter(|&part| {
                    uses[&part] == 1 && self.is_sum_or_product(part) && self.name(part).is_none()
                });
                open.extend(parts.map(|part| (part, depth.unwrap_or(0) + 1)));
            }
        }
        let open: HashSet<Node> = open.into_keys().collect();
        let mut factoring =
            Factoring { graph: self, kept, open, rewritten: HashMap::new(), products: HashSet::new() };
        for node in nodes {
            if !factoring.open.contains(&node) {
                factoring.rewrite(node);
            }
        }
        outputs.iter().map(|output| factoring.rewritten[output]).collect()
    }

    /// Of `nodes` and what they need, what stays as it is: the first `written` and what conditions are made
    /// of.
    pub(super) fn kept(&self, nodes: &[Node], written: usize) -> HashSet<Node> {
        let is_condition =
            |node: &Node| matches!(self.operation(*node), Operation::Compare(..) | Operation::Is(..));
        let conditions = nodes.iter().copied().filter(is_condition);
        let mut kept: HashSet<Node> = self.reachable(conditions).into_iter().collect();
        kept.extend(nodes.iter().filter(|node| node.index() < written));
        kept
    }

    fn is_sum_or_product(&self, node: Node) -> bool {
        matches!(
            self.operation(node),
            Operation::Add(..) | Operation::Subtract(..) | Operation::Multiply(..) | Operation::Negate(_)
        )
    }
}

impl Factoring<'_> {
    /// Rewrites a node whose arguments are rewritten or open.
    fn rewrite(&mut self, node: Node) {
        let new = if self.kept.contains(&node) {
            node
        } else if self.graph.is_sum_or_product(node) {
            let terms = self.terms(node);
            self.sum(terms)
        } else {
            let operation = self.graph.operation(node).with_arguments(|argument| self.rewritten[&argument]);
            self.graph.node(operation)
        };
        if new != node
            && let Some(name) = self.graph.name(node).map(str::to_owned)
        {
            self.graph.give_name(new, &name);
        }
        if matches!(self.graph.operation(new), Operation::Multiply(..)) {
            self.products.insert(new);
        }
        self.rewritten.insert(node, new);
    }

    /// The terms of the sum that `node` is the root of.
    fn terms(&mut self, node: Node) -> Vec<Term> {
        match self.graph.operation(node) {
            Operation::Add(a, b) => [self.part(a), self.part(b)].concat(),
            Operation::Subtract(a, b) => {
                let mut terms = self.part(a);
                terms.extend(negated(self.part(b)));
                terms
            }
            Operation::Negate(a) => negated(self.part(a)),
            Operation::Multiply(a, b) => {
                let mut product = Term::constant(1.0);
                let mut sums = Vec::new();
                self.multiply(&mut product, &mut sums, a);
                self.multiply(&mut product, &mut sums, b);
                self.product_of_sums(product, sums)
            }
            _ => vec![Term { coefficient: 1.0, factors: vec![self.rewritten[&node]] }],
        }
    }

    /// The terms of a part of a sum.
    fn part(&mut self, node: Node) -> Vec<Term> {
        if self.open.contains(&node) {
            return self.terms(node);
        }
        match self.graph.constant_value(node) {
            Some(value) => vec![Term::constant(value)],
            None => vec![Term { coefficient: 1.0, factors: vec![self.rewritten[&node]] }],
        }
    }

    /// Multiplies `product` by `node`; sums within it are set aside.
    fn multiply(&mut self, product: &mut Term, sums: &mut Vec<Vec<Term>>, node: Node) {
        if let Some(value) = self.graph.constant_value(node)
            && product.scale(value)
        {
            return;
        }
        if !self.open.contains(&node) {
            product.factors.push(self.rewritten[&node]);
            return;
        }
        match self.graph.operation(node) {
            Operation::Multiply(a, b) => {
                self.multiply(product, sums, a);
                self.multiply(product, sums, b);
            }
            Operation::Negate(a) => {
                product.coefficient = -product.coefficient;
                self.multiply(product, sums, a);
            }
            _ => sums.push(self.terms(node)),
        }
    }

    /// A product of factors and sums, as the terms of a sum: one, unless a single sum takes up the constant.
    fn product_of_sums(&mut self, mut product: Term, mut sums: Vec<Vec<Term>>) -> Vec<Term> {
        self.join_constants(&mut product);
        for sum in &mut sums {
            if product.coefficient != 1.0
                && let Some(scaled) = scaled_without_cost(sum, product.coefficient)
            {
                (*sum, product.coefficient) = (scaled, 1.0);
            }
        }
        if product.factors.is_empty() && product.coefficient == 1.0 && sums.len() == 1 {
            return sums.remove(0);
        }
        for sum in sums {
            let node = self.sum(sum);
            match self.graph.operation(node) {
                Operation::Negate(a) => {
                    product.coefficient = -product.coefficient;
                    product.factors.push(a);
                }
                _ => product.factors.push(node),
            }
        }
        vec![product]
    }

    /// Where a constant is left in front, one within a factor joins it: 2 (¼ β) s = ½ β s.
    fn join_constants(&self, product: &mut Term) {
        let factors = std::mem::take(&mut product.factors);
        for factor in factors {
            let mut inner = Term::constant(1.0);
            let joins = product.coefficient.abs() != 1.0
                && self.flatten(&mut inner, factor)
                && inner.coefficient.abs() != 1.0;
            if joins && product.scale(inner.coefficient) {
                product.factors.extend(inner.factors);
            } else {
                product.factors.push(factor);
            }
        }
    }

    /// Multiplies `product` by the factors of `node`, unless they are very many: squares of squares are.
    fn flatten(&self, product: &mut Term, node: Node) -> bool {
        let mut ahead = vec![node];
        while let Some(node) = ahead.pop() {
            match self.graph.operation(node) {
                Operation::Multiply(a, b) => ahead.extend([b, a]),
                Operation::Constant(bits) if product.scale(f64::from_bits(bits)) => {}
                _ => product.factors.push(node),
            }
            if ahead.len() + product.factors.len() > DEEPEST as usize {
                return false;
            }
        }
        true
    }

    /// The sum of `terms`: the factor that most of them share taken out, until they share none.
    fn sum(&mut self, terms: Vec<Term>) -> Node {
        let mut terms = collected(terms);
        terms.iter_mut().for_each(|term| self.join_constants(term));
        while let Some(factor) = self.common_factor(&terms) {
            let first = terms.iter().position(|term| term.factors.contains(&factor)).unwrap_or(0);
            let (mut inside, mut rest) = (Vec::new(), Vec::new());
            for mut term in terms {
                match term.factors.iter().position(|&other| other == factor) {
                    Some(index) if term.factors.len() > 1 || term.is_scaled() => {
                        term.factors.remove(index);
                        inside.push(term);
                    }
                    _ => rest.push(term),
                }
            }
            let common = common_coefficient(&mut inside);
            let mut outer = Term { coefficient: common, factors: vec![factor] };
            let inner = self.sum(inside);
            match self.graph.operation(inner) {
                Operation::Negate(a) => {
                    outer.coefficient = -outer.coefficient;
                    outer.factors.push(a);
                }
                _ => outer.factors.push(inner),
            }
            rest.insert(first.min(rest.len()), outer);
            terms = rest;
        }
        self.added(terms)
    }

    /// The factor that taking out saves most multiplications.
    fn common_factor(&self, terms: &[Term]) -> Option<Node> {
        let mut counts: Vec<(Node, u32)> = Vec::new();
        for term in terms.iter().filter(|term| term.factors.len() > 1 || term.is_scaled()) {
            for (index, &factor) in term.factors.iter().enumerate() {
                if term.factors[..index].contains(&factor) {
                    continue;
                }
                match counts.iter_mut().find(|(known, _)| *known == factor) {
                    Some((_, count)) => *count += 1,
                    None => counts.push((factor, 1)),
                }
            }
        }
        let most = counts.iter().map(|&(_, count)| count).max().filter(|&count| count > 1)?;
        counts.into_iter().filter(|&(_, count)| count == most).map(|(factor, _)| factor).min()
    }

    /// The sum of terms that share nothing.
    fn added(&mut self, mut terms: Vec<Term>) -> Node {
        // One without a sign leads.
        if let Some(leading) = terms.iter().position(|term| term.coefficient.is_sign_positive()) {
            terms[..=leading].rotate_right(1);
        }
        let is_negative = terms.first().is_some_and(|term| term.coefficient.is_sign_negative());
        let mut sum = None;
        for term in terms {
            let product = self.product(&term);
            sum = Some(match sum {
                None => product,
                Some(sum) if term.coefficient.is_sign_negative() == is_negative => {
                    self.graph.node(Operation::Add(sum, product))
                }
                Some(sum) => self.graph.node(Operation::Subtract(sum, product)),
            });
        }
        let sum = sum.unwrap_or_else(|| self.graph.constant(0.0));
        if is_negative { self.graph.negated(sum) } else { sum }
    }

    /// A term without its sign.
    fn product(&mut self, term: &Term) -> Node {
        let size = term.coefficient.abs();
        let (mut fixed, mut varying): (Vec<Node>, Vec<Node>) =
            term.factors.iter().partition(|factor| !self.graph.depends(**factor));
        fixed.sort_unstable();
        varying.sort_unstable();
        let mut product = (size != 1.0 || term.factors.is_empty()).then(|| self.graph.constant(size));
        for factor in fixed {
            product = Some(self.multiplied(product, factor));
        }
        // A pair that is computed anyway first.
        while let Some(pair) = self.known_pair(product, &varying) {
            let Some(node) = self.graph.known(Operation::Multiply(pair.0, pair.1)) else { break };
            for used in [pair.0, pair.1] {
                match varying.iter().position(|&factor| factor == used) {
                    Some(index) => drop(varying.remove(index)),
                    None => product = None,
                }
            }
            varying.push(node);
        }
        for factor in varying {
            product = Some(self.multiplied(product, factor));
        }
        product.unwrap_or_else(|| self.graph.one())
    }

    fn multiplied(&mut self, product: Option<Node>, factor: Node) -> Node {
        let Some(product) = product else { return factor };
        if let Some(step_size) = self.graph.as_step_size(product, factor) {
            return step_size;
        }
        let node = self.graph.node(Operation::Multiply(product, factor));
        self.products.insert(node);
        node
    }

    /// Two of the factors, or `product` and one of them, whose product the function computes.
    fn known_pair(&self, product: Option<Node>, factors: &[Node]) -> Option<(Node, Node)> {
        let is_known = |a: Node, b: Node| {
            self.graph.known(Operation::Multiply(a, b)).is_some_and(|node| self.products.contains(&node))
        };
        let with_product = product
            .filter(|&product| !factors.contains(&product))
            .and_then(|product| factors.iter().find(|&&b| is_known(product, b)).map(|&b| (product, b)));
        with_product.or_else(|| {
            (0..factors.len()).find_map(|i| {
                (i + 1..factors.len())
                    .find(|&j| is_known(factors[i], factors[j]))
                    .map(|j| (factors[i], factors[j]))
            })
        })
    }
}

fn negated(mut terms: Vec<Term>) -> Vec<Term> {
    terms.iter_mut().for_each(|term| term.coefficient = -term.coefficient);
    terms
}

/// Terms of the same factors as one; not where nothing would be left, lest a NaN be hidden.
fn collected(terms: Vec<Term>) -> Vec<Term> {
    let mut sum: Vec<Term> = Vec::with_capacity(terms.len());
    for mut term in terms {
        term.factors.sort_unstable();
        let total = sum.iter_mut().find(|known| known.factors == term.factors).and_then(|known| {
            let total = exact(known.coefficient + term.coefficient, &[known.coefficient, term.coefficient])
                .filter(|&total| total != 0.0 && !term.factors.is_empty())?;
            known.coefficient = total;
            Some(())
        });
        if total.is_none() {
            sum.push(term);
        }
    }
    sum
}

/// Takes the constant that all terms share out of them, with their sign where all have one.
fn common_coefficient(terms: &mut [Term]) -> f64 {
    let size = terms[0].coefficient.abs();
    // Where terms cancelled, 0 and what it would be divided by are no common factor.
    let may_divide = size > 0.0 && size.is_finite();
    let common =
        if may_divide && terms.iter().all(|term| term.coefficient.abs() == size) { size } else { 1.0 };
    let sign = if terms.iter().all(|term| term.coefficient.is_sign_negative()) { -1.0 } else { 1.0 };
    terms.iter_mut().for_each(|term| term.coefficient = sign * term.coefficient / common);
    sign * common
}

/// The sum multiplied by a constant, where that leaves fewer multiplications than one more.
fn scaled_without_cost(terms: &[Term], factor: f64) -> Option<Vec<Term>> {
    let mut scaled = terms.to_vec();
    if !scaled.iter_mut().all(|term| term.scale(factor)) {
        return None;
    }
    let cost = |terms: &[Term]| terms.iter().filter(|term| term.is_scaled()).count();
    let before = cost(terms) + usize::from(factor.abs() != 1.0);
    (cost(&scaled) < before || factor == -1.0).then_some(scaled)
}
