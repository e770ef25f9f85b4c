//! Size of the patch under the nominal load.

use super::choices::ContactShape;
use super::dependent::CURVATURES;
use super::patch_rows::{self, PatchRows, PatchTable, RowsError};
use super::table::Config;
use crate::analytic::{contact_modulus, hertz_half_width};
use crate::patch::{Ellipse, Hertz};

/// Patch under the nominal load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NominalPatch {
    /// Half of its length along the direction of rolling \[m].
    pub half_length: f64,
    /// Width across it \[m].
    pub width: f64,
}

impl Config {
    /// Hertz's contact of bodies with the radii of curvature of wheel and rail, within the range of their ratio.
    pub fn hertz(&self) -> Hertz {
        let material = &self.material;
        let [low, high] = CURVATURES.map(|ratio| ratio / self.wheel.radius);
        let modulus = contact_modulus(material.youngs_modulus, material.poissons_ratio);
        Hertz::new(self.wheel.radius, 1.0 / self.lateral_curvature().clamp(low, high), modulus)
    }

    /// Curvature of the gap across the direction of rolling [1/m].
    pub(super) fn lateral_curvature(&self) -> f64 {
        let of = |radius: f64| if radius == 0.0 { 0.0 } else { 1.0 / radius };
        of(self.contact.wheel_lateral_radius) + of(self.contact.rail_lateral_radius)
    }

    /// Rows of the patch under the nominal load, in which those of `contact.rows` under `contact.rows_load` are scaled as
    /// Hertz's patches are, lengths with the third root of the load; none where it has another shape.
    ///
    /// # Errors
    /// Rows without meaning, and a file that has not been read.
    pub fn patch_rows(&self) -> Result<Option<PatchRows>, RowsError> {
        Ok(self.patch_table()?.map(|table| table.middle().clone()))
    }

    /// Rows of the patch over the shift of the wheelset under the nominal load; `None` where its shape is not given by rows.
    ///
    /// # Errors
    /// Rows without meaning, and a file that has not been read.
    pub fn patch_table(&self) -> Result<Option<PatchTable>, RowsError> {
        let text = &self.contact.rows;
        match self.contact.shape {
            ContactShape::Line | ContactShape::Ellipse => Ok(None),
            ContactShape::Rows if patch_rows::is_file(text) => Err(RowsError::Unread(text.clone())),
            ContactShape::Rows => {
                let given = PatchTable::parse(text, self.contact.rows_load)?;
                if given.shifts.len() > 1 && !self.wheelset.side.is_known() {
                    return Err(RowsError::NoWheelset);
                }
                let grown = given.grown(libm::cbrt(self.model.nominal_load / self.contact.rows_load));
                Ok(Some(if self.wheelset.side.is_mirrored() { grown.mirrored() } else { grown }))
            }
        }
    }

    /// Refuses a text of rows without meaning, even where the patch has another shape; a file is read when the model is
    /// prepared.
    pub(super) fn check_rows(&self) -> Result<(), RowsError> {
        let text = &self.contact.rows;
        if patch_rows::is_file(text) {
            return Ok(());
        }
        match (self.contact.shape.has_rows(), text.is_empty()) {
            (true, _) => self.patch_table().map(|_| ()),
            (false, true) => Ok(()),
            (false, false) => PatchTable::parse(text, self.contact.rows_load).map(|_| ()),
        }
    }

    /// Patch under the nominal load, for rows in a file that has not been read that of an ellipse. A line has the half-width `a = √(4 P R / (π E*))` of the Hertzian line contact of
    /// a cylinder on a plane of the same material (Johnson, *Contact Mechanics* (1985), eq. 4.43).
    pub fn nominal_patch(&self) -> NominalPatch {
        let (model, material) = (&self.model, &self.material);
        if let Ok(Some(rows)) = self.patch_rows() {
            return NominalPatch { half_length: rows.half_length(), width: rows.width() };
        }
        match self.contact.shape {
            ContactShape::Line => {
                let modulus = contact_modulus(material.youngs_modulus, material.poissons_ratio);
                let load = model.nominal_load / model.contact_width;
                let half_length = hertz_half_width(load, self.wheel.radius, modulus);
                NominalPatch { half_length, width: model.contact_width }
            }
            ContactShape::Ellipse | ContactShape::Rows => {
                let Ellipse { a, b, .. } = self.hertz().under(model.nominal_load);
                NominalPatch { half_length: a, width: 2.0 * b }
            }
        }
    }
}
