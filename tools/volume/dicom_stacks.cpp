// Sorts the slices of a folder into stacks: by what their headers say, never by their names.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "tools/volume/dicom_slice.hpp"

namespace orcart {

namespace {

double dot(const PlainPoint& a, const PlainPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

std::string millimetres(double mm) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g mm", mm);
  return text;
}

/// What all slices of one stack share. Directions to 0.001 (0.06 degrees), which scanners write them to.
std::string kind_of(const DicomSlice& slice) {
  std::string key = slice.series + "|" + slice.frame_of_reference + "|" + slice.variant + "|" +
                    std::to_string(slice.columns) + "x" + std::to_string(slice.rows);
  for (const auto& direction : {slice.along_columns, slice.along_rows})
    for (const double x : direction) key += "|" + std::to_string(std::lround(x * 1000));
  for (const double step : {slice.column_step_mm, slice.row_step_mm})
    key += "|" + std::to_string(std::lround(step * 1e5));
  return key;
}

double median(std::vector<double> numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

/// The least and the most that neighbours are apart along the normal, mm.
std::pair<double, double> steps_of(const std::vector<DicomSlice>& slices, const PlainPoint& normal) {
  double least = std::numeric_limits<double>::max(), most = 0;
  for (std::size_t i = 1; i < slices.size(); ++i) {
    const double step = height_mm(slices[i], normal) - height_mm(slices[i - 1], normal);
    least = std::min(least, step);
    most = std::max(most, step);
  }
  return {least, most};
}

DicomStack stack_of(std::vector<DicomSlice> slices) {
  const DicomSlice& first = slices.front();
  const DicomSlice& last = slices.back();
  DicomStack stack;
  stack.lattice = {.size = {first.columns, first.rows, static_cast<int>(slices.size())},
                   .origin_mm = first.position_mm,
                   .step_mm = {}};
  const PlainPoint normal = normal_of(first);
  for (std::size_t row = 0; row < 3; ++row) {
    stack.lattice.step_mm[0][row] = first.along_columns[row] * first.column_step_mm;
    stack.lattice.step_mm[1][row] = first.along_rows[row] * first.row_step_mm;
    stack.lattice.step_mm[2][row] = slices.size() > 1 ? (last.position_mm[row] - first.position_mm[row]) /
                                                            static_cast<double>(slices.size() - 1)
                                                      : normal[row] * std::max(first.thickness_mm, 1e-3);
  }
  double worst_mm = 0;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const PlainPoint expected = place_of(stack.lattice, {0, 0, static_cast<double>(i)});
    for (std::size_t row = 0; row < 3; ++row)
      worst_mm = std::max(worst_mm, std::abs(expected[row] - slices[i].position_mm[row]));
  }
  const double step_mm = step_length_mm(stack.lattice, 2);
  constexpr double kMostUneven = 0.25;
  if (slices.size() > 2 && worst_mm > kMostUneven * step_mm) {
    const auto [least, most] = steps_of(slices, normal);
    stack.fault = "its slices are " + millimetres(least) + " to " + millimetres(most) + " apart, up to " +
                  millimetres(worst_mm) + " from an even spacing; a series of one spacing is expected";
  } else if (worst_mm > 0.02 * step_mm)
    stack.notes.push_back("slices lie up to " + millimetres(worst_mm) + " from an even spacing of " +
                          millimetres(step_mm) + "; they are taken as evenly spaced");
  const double upright = slices.size() > 1 ? std::abs(dot(stack.lattice.step_mm[2], normal)) / step_mm : 1;
  if (upright < 0.9998)
    stack.notes.push_back("the stack leans by " +
                          std::to_string(std::lround(std::acos(upright) * 1800 / M_PI) / 10.0).substr(0, 4) +
                          " degrees (a tilted gantry); it is kept so");
  stack.slices = std::move(slices);
  return stack;
}

std::string short_name(const DicomSlice& slice) {
  return slice.file.filename().string() +
         (slice.frame > 0 ? ", frame " + std::to_string(slice.frame) + "," : "");
}

/// Cuts one group, sorted along its normal, at its gaps.
void cut_at_gaps(std::vector<DicomSlice> group, std::vector<DicomStack>& stacks) {
  const PlainPoint normal = normal_of(group.front());
  const auto height = [&](const DicomSlice& slice) { return height_mm(slice, normal); };
  std::stable_sort(group.begin(), group.end(),
                   [&](const DicomSlice& a, const DicomSlice& b) { return height(a) < height(b); });
  std::vector<double> steps;
  for (std::size_t i = 1; i < group.size(); ++i) {
    steps.push_back(height(group[i]) - height(group[i - 1]));
    if (steps.back() >= kSamePlaceMm) continue;
    std::string fault = short_name(group[i - 1]) + " and " + short_name(group[i]) +
                        " lie at the same place and nothing in them says why; one volume (one series, one "
                        "time, one echo) is expected";
    stacks.push_back(stack_of(std::move(group)));
    stacks.back().fault = std::move(fault);
    return;
  }
  const double usual = steps.empty() ? 0 : median(steps);
  std::vector<DicomSlice> part;
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (i > 0 && steps[i - 1] > 1.5 * usual) stacks.push_back(stack_of(std::exchange(part, {})));
    part.push_back(std::move(group[i]));
  }
  stacks.push_back(stack_of(std::move(part)));
}

std::string describe(const DicomStack& stack) {
  const DicomSlice &first = stack.slices.front(), &last = stack.slices.back();
  const PlainPoint normal = normal_of(first);
  char text[160];
  std::snprintf(text, sizeof text, "%zu slices %.6g mm apart, from %.6g to %.6g mm along their normal",
                stack.slices.size(), step_length_mm(stack.lattice, 2), dot(first.position_mm, normal),
                dot(last.position_mm, normal));
  std::string said = text;
  if (!first.variant.empty()) said += " (" + first.variant + ")";
  if (!first.series.empty())
    said += ", series ..." +
            first.series.substr(first.series.size() - std::min<std::size_t>(first.series.size(), 12));
  if (!stack.fault.empty()) said += ", no volume: " + stack.fault;
  return said;
}

/// Whether two stacks could be one volume of which slices are missing.
bool of_one_scan(const DicomStack& a, const DicomStack& b) {
  const DicomSlice &first = a.slices.front(), &second = b.slices.front();
  constexpr double kSameDirection = 0.9999;
  return first.series == second.series && dot(first.along_columns, second.along_columns) > kSameDirection &&
         dot(first.along_rows, second.along_rows) > kSameDirection;
}

/// Leaves out and counts images without a place. Refuses where nothing is left, and a frame without one: it
/// is missing from among others.
Result<std::size_t> drop_placeless(std::vector<DicomSlice>& slices) {
  const auto placeless = [](const DicomSlice& slice) { return !slice.has_position; };
  const auto is_frame = [](const DicomSlice& slice) { return !slice.has_position && slice.frame > 0; };
  auto first = std::find_if(slices.begin(), slices.end(), is_frame);
  const bool all = std::all_of(slices.begin(), slices.end(), placeless);
  if (all) first = slices.begin();
  if (first != slices.end())
    return fail(name_of(*first) +
                ": states no ImagePositionPatient and ImageOrientationPatient; slices that say where they "
                "lie are expected (a secondary capture has no place)");
  return std::erase_if(slices, placeless);
}

/// A scanner that steps or pauses counts acquisitions up within one volume; one that scans twice, with and
/// without contrast, does too; files and the stacks in a file are alike. They are one volume where the next
/// begins behind the last one's end, else each is one of its own, and says so with `label`.
std::vector<std::vector<DicomSlice>> by_part(std::vector<DicomSlice> group, std::string DicomSlice::*key,
                                             const std::string& label) {
  std::map<std::string, std::vector<DicomSlice>> parts;
  const PlainPoint normal = normal_of(group.front());
  for (const DicomSlice& slice : group) parts[slice.*key].push_back(slice);
  std::vector<std::pair<double, double>> spans;
  for (const auto& [number, part] : parts) {
    const auto [low, high] = std::minmax_element(part.begin(), part.end(), [&](const auto& a, const auto& b) {
      return height_mm(a, normal) < height_mm(b, normal);
    });
    spans.emplace_back(height_mm(*low, normal), height_mm(*high, normal));
  }
  std::sort(spans.begin(), spans.end());
  bool apart = true;
  for (std::size_t i = 1; i < spans.size(); ++i)
    apart = apart && spans[i].first > spans[i - 1].second + kSamePlaceMm;
  std::vector<std::vector<DicomSlice>> groups;
  if (apart) {
    groups.push_back(std::move(group));
    return groups;
  }
  for (auto& [number, part] : parts) {
    for (DicomSlice& slice : part)
      slice.variant = label + " " + number + (slice.variant.empty() ? "" : ", " + slice.variant);
    groups.push_back(std::move(part));
  }
  return groups;
}

/// One group of a kind, as the volumes in it.
std::vector<std::vector<DicomSlice>> volumes_of(std::vector<DicomSlice> group) {
  auto groups = split_by_facets(std::move(group));
  const auto refine = [&](std::string DicomSlice::*key, const std::string& label) {
    std::vector<std::vector<DicomSlice>> finer;
    for (auto& one : groups)
      for (auto& part : by_part(std::move(one), key, label)) finer.push_back(std::move(part));
    groups = std::move(finer);
  };
  refine(&DicomSlice::acquisition, "acquisition");
  refine(&DicomSlice::part, "file");
  refine(&DicomSlice::block, "stack");
  return groups;
}

/// The same image copied twice into a folder: its instance, place and kind are the same. Says how many went.
std::size_t drop_copies(std::vector<DicomSlice>& slices) {
  std::set<std::string> known;
  return std::erase_if(slices, [&](const DicomSlice& slice) {
    if (slice.instance.empty() || !slice.has_position) return false;
    std::string key =
        slice.instance + "|" + std::to_string(slice.frame) + "|" + slice.acquisition + "|" + kind_of(slice);
    for (const double x : slice.position_mm) key += "|" + std::to_string(x);
    return !known.insert(key).second;
  });
}

}  // namespace

std::string name_of(const DicomSlice& slice) {
  return slice.file.string() + (slice.frame > 0 ? ", frame " + std::to_string(slice.frame) : "");
}

PlainPoint normal_of(const DicomSlice& slice) {
  const auto& [u, v] = std::tie(slice.along_columns, slice.along_rows);
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

double height_mm(const DicomSlice& slice, const PlainPoint& normal) {
  return dot(slice.position_mm, normal);
}

Result<std::vector<DicomStack>> stack_slices(const std::string& folder, std::vector<DicomSlice> slices) {
  std::set<std::size_t> patients;
  for (const DicomSlice& slice : slices) patients.insert(slice.patient);
  if (patients.size() > 1)
    return fail(folder + ": holds images of " + std::to_string(patients.size()) +
                " patients; the images of one are expected");
  const std::size_t copies = drop_copies(slices);
  const auto placeless = drop_placeless(slices);
  if (!placeless) return tl::unexpected(placeless.error());
  std::map<std::string, std::vector<DicomSlice>> groups;
  for (DicomSlice& slice : slices) groups[kind_of(slice)].push_back(std::move(slice));
  std::vector<DicomStack> stacks;
  for (auto& [kind, group] : groups)
    for (auto& part : volumes_of(std::move(group))) cut_at_gaps(std::move(part), stacks);
  for (DicomStack& stack : stacks) {
    if (copies > 0)
      stack.notes.push_back(std::to_string(copies) +
                            " images are in the folder twice; one of each was taken");
    if (*placeless > 0)
      stack.notes.push_back(std::to_string(*placeless) +
                            " images that do not say where they lie (secondary captures?) were left out");
  }
  std::stable_sort(stacks.begin(), stacks.end(), [](const DicomStack& a, const DicomStack& b) {
    return a.slices.size() > b.slices.size();
  });
  return stacks;
}

Result<DicomStack> choose_stack(const std::string& folder, std::vector<DicomStack> stacks, int wanted) {
  const auto is_thick = [](const DicomStack& stack) { return stack.slices.size() > 1; };
  const auto is_volume = [&](const DicomStack& stack) { return is_thick(stack) && stack.fault.empty(); };
  const auto thick = std::count_if(stacks.begin(), stacks.end(), is_thick);
  if (wanted >= 1 && static_cast<std::size_t>(wanted) <= stacks.size()) {
    DicomStack& named = stacks[static_cast<std::size_t>(wanted) - 1];
    if (!named.fault.empty()) return fail(folder + ": stack " + std::to_string(wanted) + ": " + named.fault);
    return std::move(named);
  }
  if (wanted == 0 && stacks.size() == 1 && !stacks.front().fault.empty())
    return fail(folder + ": " + stacks.front().fault);
  if (wanted == 0 && std::count_if(stacks.begin(), stacks.end(), is_volume) == 1) {
    const auto only = std::find_if(stacks.begin(), stacks.end(), is_volume);
    const auto stranger = [&](const DicomStack& other) {
      return &other == &*only || !of_one_scan(other, *only);
    };
    if (std::all_of(stacks.begin(), stacks.end(), stranger)) {
      DicomStack chosen = std::move(*only);
      const std::size_t faulty = static_cast<std::size_t>(thick) - 1, lone = stacks.size() - 1 - faulty;
      if (lone > 0)
        chosen.notes.push_back(std::to_string(lone) +
                               " single images that belong to no stack (a localizer?) were left out");
      for (const DicomStack& other : stacks)
        if (!other.fault.empty())
          chosen.notes.push_back(std::to_string(other.slices.size()) +
                                 " images of another series were left out: " + other.fault);
      return chosen;
    }
  }
  if (thick == 0)
    return fail(folder + ": holds " + std::to_string(stacks.size()) +
                " DICOM image(s), none beside another; a stack of slices is expected");
  std::string list;
  constexpr std::size_t kMostListed = 8;
  for (std::size_t i = 0; i < std::min(stacks.size(), kMostListed); ++i)
    list += "; " + std::to_string(i + 1) + ": " + describe(stacks[i]);
  if (stacks.size() > kMostListed) list += "; and so on";
  return fail(folder + ": is no single volume but " + std::to_string(stacks.size()) +
              " stacks (slices missing between them, or several series, echoes or times)" + list +
              "; --stack N, to take one of them, is expected" +
              (wanted > 0 ? " with N up to " + std::to_string(stacks.size()) : ""));
}

}  // namespace orcart
