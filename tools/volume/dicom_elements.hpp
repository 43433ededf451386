// Values out of GDCM's data sets, none of which is believed to be there.
#pragma once

#include <gdcmDataSet.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace orcart {

/// The text of an element, "" where it is missing; several values are separated by backslashes.
std::string text_at(const gdcm::DataSet& set, const gdcm::Tag& tag);
/// So many finite numbers written as text.
std::optional<std::vector<double>> numbers_at(const gdcm::DataSet& set, const gdcm::Tag& tag,
                                              std::size_t count);
double number_at(const gdcm::DataSet& set, const gdcm::Tag& tag, double fallback);
/// Of 16 bits; 0 where it is missing.
int short_at(const gdcm::DataSet& set, const gdcm::Tag& tag);
/// Binary numbers (FD; UL or US), empty where they are missing.
std::vector<double> doubles_at(const gdcm::DataSet& set, const gdcm::Tag& tag);
std::vector<std::uint32_t> counts_at(const gdcm::DataSet& set, const gdcm::Tag& tag);
/// An element that points to another, as group * 0x10000 + element; 0 where it is missing.
std::uint32_t pointer_at(const gdcm::DataSet& set, const gdcm::Tag& tag);
/// The items of a sequence; empty where it is missing.
std::vector<gdcm::DataSet> items_at(const gdcm::DataSet& set, const gdcm::Tag& tag);

}  // namespace orcart
