//! Prints the `modelDescription.xml` of the coach.

fn main() {
    print!("{}", coach::fmi::description::model_description());
}
