//! Prints the `modelDescription.xml` of the coach.

fn main() {
    print!("{}", coach::fmi::v2::description::model_description());
}
