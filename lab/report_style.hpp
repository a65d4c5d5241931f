// How report.html looks, and what moves in it.
#pragma once

#include <string>
#include <string_view>

namespace lab {

/// The style sheet, with the colours of all series.
std::string report_style();

/// The slider between two pictures, which are those that the page shows anyway.
std::string_view report_script();

} // namespace lab
