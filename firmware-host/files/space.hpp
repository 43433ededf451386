// The two patient spaces that files of surfaces and volumes come in.
#pragma once

namespace orcart {

/// Both right-handed, millimetres: x to the patient's left and y to the back (DICOM), or x right and y front.
enum class Space { lps, ras };

}  // namespace orcart
