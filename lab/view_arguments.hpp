// Cameras and lights as the command line names them.
#pragma once

#include "lab/scene.hpp"

#include <string>

namespace lab {

/// The camera that `text` names in `world`: a number, or ex,ey,ez,tx,ty,tz,fov.
/// @throws bad_input with one line for anything that cannot be understood.
camera_view resolve_camera(const std::string& text, const scene& world);

/// The light that `text` names in `world`: a number, or sun:…, spot:…, point:….
/// @throws bad_input with one line for anything that cannot be understood.
light_view resolve_light(const std::string& text, const scene& world);

/// "sun", "spot" or "point".
std::string kind_text(warpshadow::light_kind kind);

/// The lab's syntax for a camera and a light, as --list-scenes shows them.
std::string camera_text(const camera_view& camera);
std::string light_text(const light_view& light);

} // namespace lab
