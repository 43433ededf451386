// `orcart paint --difference`: paper mode against perspective, from views to a file and a sentence.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "firmware-host/files/views_file.hpp"
#include "firmware-host/offline/difference_map.hpp"

namespace orcart {

/// All views, the newest last. Borrows surface, scope and layout. Refuses a view that paper mode has no scale
/// for, by its picture's name.
Result<DifferenceMap> difference_of(const Surface& surface, const ScopeModel& scope,
                                    const AtlasLayout& layout, SeenFrom seen_from,
                                    const std::vector<View>& views);

/// A textured surface, or where `file` ends in .png what the scope at the view `last` sees, turned as it was.
/// `places` as write_textured wants them.
Result<void> write_difference(const std::string& file, const DifferenceMap& map, const Surface& surface,
                              std::span<const std::array<Eigen::Vector2f, 3>> places, const View& last);

std::string difference_text(const ModeDifference& difference, const std::string& file);
/// A member of an object, with its comma.
std::string difference_json(const ModeDifference& difference);

}  // namespace orcart
