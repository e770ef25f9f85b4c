//! FMI 3.0: the rows of the table, arrays among them, the model description, the wheel as a slave, and the exported C
//! functions.

pub mod access;
pub mod c_abi;
pub mod description;
