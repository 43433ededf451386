// Text, binary numbers and sequences of a data set.
#include "tools/volume/dicom_elements.hpp"

#include <gdcmSequenceOfItems.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tools/volume/header_words.hpp"

namespace orcart {

namespace {

/// Numbers of one width, in the order of the machine's bytes, into which GDCM turns them.
template <class Number, class Out>
std::vector<Out> binary_at(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  std::vector<Out> numbers;
  if (!set.FindDataElement(tag)) return numbers;
  const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
  if (value == nullptr) return numbers;
  for (std::size_t at = 0; at + sizeof(Number) <= value->GetLength(); at += sizeof(Number)) {
    Number number;
    std::memcpy(&number, value->GetPointer() + at, sizeof number);
    numbers.push_back(static_cast<Out>(number));
  }
  return numbers;
}

}  // namespace

std::string text_at(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  if (!set.FindDataElement(tag)) return {};
  const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
  if (value == nullptr) return {};
  std::string text(value->GetPointer(), value->GetLength());
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return std::string(trimmed(text));
}

std::optional<std::vector<double>> numbers_at(const gdcm::DataSet& set, const gdcm::Tag& tag,
                                              std::size_t count) {
  std::string text = text_at(set, tag);
  std::replace(text.begin(), text.end(), '\\', ' ');
  auto numbers = numbers_of(text, count);
  if (numbers && !std::all_of(numbers->begin(), numbers->end(), [](double x) { return std::isfinite(x); }))
    return std::nullopt;
  return numbers;
}

double number_at(const gdcm::DataSet& set, const gdcm::Tag& tag, double fallback) {
  const auto number = numbers_at(set, tag, 1);
  return number ? (*number)[0] : fallback;
}

int short_at(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  if (!set.FindDataElement(tag)) return 0;
  const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
  if (value == nullptr || value->GetLength() < 2) return 0;
  std::uint16_t number = 0;
  std::copy_n(value->GetPointer(), 2, reinterpret_cast<char*>(&number));
  return number;
}

std::vector<double> doubles_at(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  return binary_at<double, double>(set, tag);
}

std::vector<std::uint32_t> counts_at(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  const bool narrow = set.FindDataElement(tag) && set.GetDataElement(tag).GetVL() == 2;
  return narrow ? binary_at<std::uint16_t, std::uint32_t>(set, tag)
                : binary_at<std::uint32_t, std::uint32_t>(set, tag);
}

std::uint32_t pointer_at(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  const auto halves = binary_at<std::uint16_t, std::uint32_t>(set, tag);
  return halves.size() == 2 ? halves[0] << 16U | halves[1] : 0;
}

std::vector<gdcm::DataSet> items_at(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  std::vector<gdcm::DataSet> items;
  if (!set.FindDataElement(tag)) return items;
  const auto sequence = set.GetDataElement(tag).GetValueAsSQ();
  if (!sequence) return items;
  for (std::size_t i = 1; i <= sequence->GetNumberOfItems(); ++i)
    items.push_back(sequence->GetItem(i).GetNestedDataSet());
  return items;
}

}  // namespace orcart
