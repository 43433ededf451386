// Tells frames at one place apart by what their headers say: echo, time, diffusion and the like.
#include <algorithm>
#include <map>

#include "firmware-host/files/text_cursor.hpp"
#include "tools/volume/dicom_slice.hpp"

namespace orcart {

namespace {

using Group = std::vector<DicomSlice>;

std::string value_of(const DicomSlice& slice, const std::string& facet) {
  for (const Facet& one : slice.facets)
    if (one.name == facet) return one.value;
  return {};
}

/// "9 ms" before "10 ms".
struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    const auto x = TextCursor(a).number<double>(), y = TextCursor(b).number<double>();
    if (x && y && *x != *y) return *x < *y;
    if (x.has_value() != y.has_value()) return x.has_value();
    return a < b;
  }
};

std::vector<std::string> facet_names(const Group& group) {
  std::vector<std::string> names;
  for (const DicomSlice& slice : group)
    for (const Facet& facet : slice.facets)
      if (std::find(names.begin(), names.end(), facet.name) == names.end()) names.push_back(facet.name);
  return names;
}

/// Whether `differ` holds between any slice and the first at the same place, in a group sorted by height.
template <class Differ>
bool any_at_one_place(const Group& group, const Differ& differ) {
  const PlainPoint normal = normal_of(group.front());
  std::size_t first = 0;
  for (std::size_t i = 1; i < group.size(); ++i) {
    if (height_mm(group[i], normal) - height_mm(group[i - 1], normal) >= kSamePlaceMm)
      first = i;
    else if (differ(group[first], group[i]))
      return true;
  }
  return false;
}

void split(Group group, const std::vector<std::string>& names, std::size_t from, std::vector<Group>& out) {
  const auto always = [](const DicomSlice&, const DicomSlice&) { return true; };
  for (; from < names.size() && any_at_one_place(group, always); ++from) {
    const std::string& name = names[from];
    const auto differ = [&](const DicomSlice& a, const DicomSlice& b) {
      return value_of(a, name) != value_of(b, name);
    };
    if (!any_at_one_place(group, differ)) continue;
    std::map<std::string, Group, NaturalOrder> parts;
    for (DicomSlice& slice : group) {
      const std::string value = value_of(slice, name);
      const std::string said = name + " " + (value.empty() ? "none" : value);
      slice.variant += (slice.variant.empty() ? "" : ", ") + said;
      parts[value].push_back(std::move(slice));
    }
    for (auto& [value, part] : parts) split(std::move(part), names, from + 1, out);
    return;
  }
  out.push_back(std::move(group));
}

}  // namespace

std::vector<std::vector<DicomSlice>> split_by_facets(std::vector<DicomSlice> group) {
  const PlainPoint normal = normal_of(group.front());
  std::stable_sort(group.begin(), group.end(), [&](const DicomSlice& a, const DicomSlice& b) {
    return height_mm(a, normal) < height_mm(b, normal);
  });
  const auto names = facet_names(group);
  std::vector<Group> groups;
  split(std::move(group), names, 0, groups);
  return groups;
}

}  // namespace orcart
