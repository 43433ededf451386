// Reads a covariance matrix from TOML, and refuses what cannot be one.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "firmware-host/files/toml_reader.hpp"

namespace orcart {

/// The square matrix of a key, row by row; nothing where the key is absent or was refused. Refused are a size
/// that is none of `sizes`, a matrix that is not symmetric (to 1e-6 of the two standard deviations), and one
/// with a negative eigenvalue (below -1e-6 of the correlations').
std::optional<Eigen::MatrixXd> covariance_from_toml(const TomlSection& section, std::string_view key,
                                                    std::span<const int> sizes);

}  // namespace orcart
