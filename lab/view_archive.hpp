// What was measured and seen of one view or path, as a file that a later run goes on from.
#pragma once

#include "lab/report.hpp"
#include "lab/results.hpp"

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/// Records and pictures of one view; pictures count its runs from 0.
struct archived_view {
    std::vector<run_record> runs;
    view_pictures pictures;
};

/// The end of the names of archives.
inline constexpr std::string_view archive_suffix = ".cbor";

/// Name of the archive of a view.
std::string archive_name(std::initializer_list<std::string> parts);

/// An archive; `settings` says what its records were measured with.
std::vector<std::uint8_t> archive_of(const archived_view& view, const std::string& settings);

/// An archive of methods along a path.
std::vector<std::uint8_t> archive_of(std::span<const path_record> paths,
                                     const std::string& settings);

/// What such an archive holds; nothing where it is empty, broken or of other settings.
std::optional<std::vector<path_record>> read_path_archive(std::span<const std::uint8_t> bytes,
                                                          const std::string& settings);

/// What an archive holds; nothing where it is empty, broken or of other settings.
std::optional<archived_view> read_archive(std::span<const std::uint8_t> bytes,
                                          const std::string& settings);

} // namespace lab
