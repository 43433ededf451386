// Units differ from row to row, so the tests are made on correlations.
#include "firmware-host/files/covariance_toml.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace orcart {
namespace {

constexpr double kRounding = 1e-6;

/// What is wrong with it as a covariance; empty where nothing is.
std::string fault_of(const Eigen::MatrixXd& m) {
  if (m.diagonal().minCoeff() < 0) return "has a negative variance; a covariance is accepted";
  const Eigen::VectorXd deviations = m.diagonal().cwiseSqrt();
  Eigen::MatrixXd correlations = Eigen::MatrixXd::Identity(m.rows(), m.cols());
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j) {
      const double both = deviations[i] * deviations[j];
      if (std::abs(m(i, j) - m(j, i)) > kRounding * both)
        return "is not symmetric; a covariance, row by row, is accepted";
      if (both > 0) correlations(i, j) = m(i, j) / both;
      if (both == 0 && m(i, j) != 0)
        return "is not positive semi-definite (a number without variance varies with another); a covariance "
               "is accepted";
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlations, Eigen::EigenvaluesOnly);
  if (solver.eigenvalues().minCoeff() < -kRounding)
    return "is not positive semi-definite; a covariance is accepted";
  return {};
}

std::string accepted(std::span<const int> sizes) {
  std::string words;
  for (const int size : sizes)
    words += (words.empty() ? "" : ", ") + std::to_string(size) + "x" + std::to_string(size);
  return words;
}

}  // namespace

std::optional<Eigen::MatrixXd> covariance_from_toml(const TomlSection& section, std::string_view key,
                                                    std::span<const int> sizes) {
  if (!section.has(key)) return std::nullopt;
  const std::vector<double> values = section.numbers(key, 0);
  if (values.empty()) return std::nullopt;  // refused by the getter, or an empty list: says nothing
  const auto size = std::find_if(sizes.begin(), sizes.end(), [&](int n) {
    return static_cast<std::size_t>(n) * static_cast<std::size_t>(n) == values.size();
  });
  if (size == sizes.end()) {
    section.refuse(key, "holds " + std::to_string(values.size()) + " numbers; " + accepted(sizes) +
                            ", row by row, is accepted");
    return std::nullopt;
  }
  const Eigen::MatrixXd matrix =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(values.data(),
                                                                                               *size, *size);
  if (const std::string fault = fault_of(matrix); !fault.empty()) {
    section.refuse(key, fault);
    return std::nullopt;
  }
  return (matrix + matrix.transpose()) / 2;
}

}  // namespace orcart
