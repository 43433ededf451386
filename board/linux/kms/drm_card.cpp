// Resources, properties, and the choice of connector, crtc and plane.
#include "board/linux/kms/drm_card.hpp"

#include <fcntl.h>
#include <xf86drm.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "board/linux/byte_stream.hpp"

namespace orcart {
namespace {

template <class T, void (*Free)(T*)>
struct FreeBy {
  void operator()(T* object) const noexcept { Free(object); }
};
template <class T, void (*Free)(T*)>
using Owned = std::unique_ptr<T, FreeBy<T, Free>>;
using Resources = Owned<drmModeRes, drmModeFreeResources>;
using Connector = Owned<drmModeConnector, drmModeFreeConnector>;
using Encoder = Owned<drmModeEncoder, drmModeFreeEncoder>;
using Planes = Owned<drmModePlaneRes, drmModeFreePlaneResources>;
using Plane = Owned<drmModePlane, drmModeFreePlane>;
using Properties = Owned<drmModeObjectProperties, drmModeFreeObjectProperties>;
using Property = Owned<drmModePropertyRes, drmModeFreeProperty>;

std::string name_of(const drmModeConnector& connector) {
  const char* type = drmModeGetConnectorTypeName(connector.connector_type);
  return std::string(type == nullptr ? "Unknown" : type) + "-" + std::to_string(connector.connector_type_id);
}

/// An object's property by name, with its value; id 0 where it has none.
struct FoundProperty {
  std::uint32_t id = 0;
  std::uint64_t value = 0;
  std::uint64_t bits = 0;  ///< of a bitmask: what it can be
};
FoundProperty property_of(int card, std::uint32_t object, std::uint32_t type, const char* name) {
  const Properties all(drmModeObjectGetProperties(card, object, type));
  for (std::uint32_t i = 0; all && i < all->count_props; ++i) {
    const Property property(drmModeGetProperty(card, all->props[i]));
    if (!property || std::strcmp(property->name, name) != 0) continue;
    FoundProperty found{.id = property->prop_id, .value = all->prop_values[i]};
    for (int e = 0; (property->flags & DRM_MODE_PROP_BITMASK) != 0 && e < property->count_enums; ++e)
      found.bits |= std::uint64_t{1} << property->enums[e].value;
    return found;
  }
  return {};
}

/// The crtc that feeds the connector now, or the first that could.
std::size_t crtc_for(int card, const drmModeRes& resources, const drmModeConnector& connector) {
  const auto count = static_cast<std::size_t>(resources.count_crtcs);
  if (const Encoder now(drmModeGetEncoder(card, connector.encoder_id)); now)
    for (std::size_t i = 0; i < count; ++i)
      if (now->crtc_id != 0 && resources.crtcs[i] == now->crtc_id) return i;
  for (int e = 0; e < connector.count_encoders; ++e) {
    const Encoder encoder(drmModeGetEncoder(card, connector.encoders[e]));
    for (std::size_t i = 0; encoder && i < count; ++i)
      if ((encoder->possible_crtcs >> i & 1) != 0) return i;
  }
  return count;
}

std::uint32_t primary_plane_of(int card, std::size_t crtc) {
  const Planes planes(drmModeGetPlaneResources(card));
  for (std::uint32_t i = 0; planes && i < planes->count_planes; ++i) {
    const Plane plane(drmModeGetPlane(card, planes->planes[i]));
    if (!plane || (plane->possible_crtcs >> crtc & 1) == 0) continue;
    if (property_of(card, plane->plane_id, DRM_MODE_OBJECT_PLANE, "type").value == DRM_PLANE_TYPE_PRIMARY)
      return plane->plane_id;
  }
  return 0;
}

void find_properties(int card, DrmPipe& pipe) {
  const auto of_plane = [&](const char* name) {
    return property_of(card, pipe.plane, DRM_MODE_OBJECT_PLANE, name).id;
  };
  pipe.connector_crtc = property_of(card, pipe.connector, DRM_MODE_OBJECT_CONNECTOR, "CRTC_ID").id;
  pipe.crtc_mode = property_of(card, pipe.crtc, DRM_MODE_OBJECT_CRTC, "MODE_ID").id;
  pipe.crtc_active = property_of(card, pipe.crtc, DRM_MODE_OBJECT_CRTC, "ACTIVE").id;
  pipe.plane_fb = of_plane("FB_ID");
  pipe.plane_crtc = of_plane("CRTC_ID");
  pipe.src_x = of_plane("SRC_X");
  pipe.src_y = of_plane("SRC_Y");
  pipe.src_w = of_plane("SRC_W");
  pipe.src_h = of_plane("SRC_H");
  pipe.crtc_x = of_plane("CRTC_X");
  pipe.crtc_y = of_plane("CRTC_Y");
  pipe.crtc_w = of_plane("CRTC_W");
  pipe.crtc_h = of_plane("CRTC_H");
  const FoundProperty rotation = property_of(card, pipe.plane, DRM_MODE_OBJECT_PLANE, "rotation");
  pipe.plane_rotation = rotation.id;
  if (rotation.id != 0) pipe.rotations = rotation.bits;
}

Result<DrmPipe> pipe_for(int card, const PanelWish& wish) {
  const std::vector<DisplayConnector> offered = connectors_of(card);
  const auto choice = choose(wish, offered);
  if (!choice) return tl::unexpected(choice.error());
  const Resources resources(drmModeGetResources(card));
  const Connector connector(drmModeGetConnectorCurrent(card, offered[choice->connector].id));
  if (!resources || !connector)
    return fail("panel " + wish.device + " changed while it was asked; try again");
  const std::vector<drmModeModeInfo> modes = usable_modes(*connector);
  if (choice->mode >= modes.size())
    return fail("panel " + wish.device + " changed while it was asked; try again");
  const std::size_t crtc = crtc_for(card, *resources, *connector);
  if (crtc >= static_cast<std::size_t>(resources->count_crtcs))
    return fail("panel " + wish.device + " has no free pipe for " + offered[choice->connector].name);
  DrmPipe pipe{.connector = connector->connector_id, .crtc = resources->crtcs[crtc]};
  pipe.mode = modes[choice->mode];
  pipe.plane = primary_plane_of(card, crtc);
  if (pipe.plane == 0) return fail("panel " + wish.device + " has no primary plane for its pipe");
  find_properties(card, pipe);
  return pipe;
}

Result<void> become_master(int card, const std::string& path) {
  if (drmIsMaster(card) != 0 || drmSetMaster(card) == 0) return {};
  return fail(
      "panel " + path +
      " is held by another program, a desktop most likely; end it (systemctl isolate multi-user.target)");
}

/// The first card with a panel on it, where none is named.
Result<std::string> card_for(const PanelWish& wish) {
  if (!wish.device.empty()) return wish.device;
  std::string last =
      "no display card (/dev/dri/card0) is here; load its driver, or name another [panel] kind";
  for (const std::string& path : card_paths()) {
    const auto card = open_card(path);
    if (!card) {
      last = card.error().message;
      continue;
    }
    const auto all = connectors_of(card->get());
    if (std::ranges::any_of(all, &DisplayConnector::connected)) return path;
    last = "no panel is connected to " + path + "; plug one in and switch it on";
  }
  return fail(last);
}

}  // namespace

double refresh_of(const drmModeModeInfo& mode) noexcept {
  const double pixels = double(mode.htotal) * mode.vtotal;
  if (pixels <= 0 || mode.clock == 0) return mode.vrefresh > 0 ? mode.vrefresh : 60;
  const int scans = (mode.flags & DRM_MODE_FLAG_DBLSCAN) != 0 ? 2 : 1;
  return mode.clock * 1000.0 / pixels / scans / std::max<int>(1, mode.vscan);
}

std::vector<drmModeModeInfo> usable_modes(const drmModeConnector& connector) {
  std::vector<drmModeModeInfo> usable;
  for (int m = 0; m < connector.count_modes; ++m)
    if ((connector.modes[m].flags & DRM_MODE_FLAG_INTERLACE) == 0) usable.push_back(connector.modes[m]);
  return usable;
}

std::vector<std::string> card_paths() {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/dri", error))
    if (entry.path().filename().string().starts_with("card")) paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

Result<FileDescriptor> open_card(const std::string& path) {
  FileDescriptor card(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK));
  if (card.valid()) return card;
  const PortFault fault = port_fault_of(errno);
  return fail("panel " + path + " cannot be opened: " + std::string(word_for(fault)) +
              (fault == PortFault::no_permission ? "; a user in the group video would be let in"
                                                 : "; orcart probe lists the cards there are"));
}

std::vector<DisplayConnector> connectors_of(int card) {
  std::vector<DisplayConnector> all;
  const Resources resources(drmModeGetResources(card));
  for (int i = 0; resources && i < resources->count_connectors; ++i) {
    const Connector connector(drmModeGetConnector(card, resources->connectors[i]));
    if (!connector) continue;
    DisplayConnector facts{.id = connector->connector_id,
                           .name = name_of(*connector),
                           .connected = connector->connection == DRM_MODE_CONNECTED};
    for (const drmModeModeInfo& mode : usable_modes(*connector)) {
      facts.modes.push_back(
          {mode.hdisplay, mode.vdisplay, refresh_of(mode), (mode.type & DRM_MODE_TYPE_PREFERRED) != 0});
    }
    all.push_back(std::move(facts));
  }
  return all;
}

Result<DrmCard> take_card(const PanelWish& wish) {
  auto path = card_for(wish);
  if (!path) return tl::unexpected(path.error());
  auto descriptor = open_card(*path);
  if (!descriptor) return tl::unexpected(descriptor.error());
  const int card = descriptor->get();
  if (drmSetClientCap(card, DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1) != 0 ||
      drmSetClientCap(card, DRM_CLIENT_CAP_ATOMIC, 1) != 0)
    return fail("panel " + *path + " knows no atomic commits; a card whose driver does would be accepted");
  if (auto master = become_master(card, *path); !master) return tl::unexpected(master.error());
  PanelWish named = wish;
  named.device = *path;
  auto pipe = pipe_for(card, named);
  if (!pipe) return tl::unexpected(pipe.error());
  return DrmCard{.descriptor = std::move(*descriptor), .path = *path, .pipe = *pipe};
}

}  // namespace orcart
