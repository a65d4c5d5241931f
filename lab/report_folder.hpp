// A folder that appears whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/// Files are written to a temporary folder beside the wanted one, which `publish` puts in place.
class report_folder {
  public:
    /// Makes the temporary folder and checks that it can be written to.
    ///
    /// A folder that exists already is replaced on publication if it is empty or holds an earlier
    /// report and nothing else.
    /// @param resumable the temporary folder may be kept, and the next one that is resumable and
    ///                  wants the same place finds it; only one may at a time
    /// @throws bad_input with one line when the folder cannot be made or must not be replaced.
    explicit report_folder(const std::filesystem::path& wanted, bool resumable = false);
    /// Removes the temporary folder, and the parents made for it, unless it was published or kept.
    ~report_folder();
    report_folder(const report_folder&) = delete;
    report_folder& operator=(const report_folder&) = delete;

    void write(std::string_view name, std::span<const std::uint8_t> bytes);
    void write(std::string_view name, const std::string& text);

    /// Leaves the temporary folder where it is if it is not published.
    void keep() { kept_ = true; }
    /// Content of a file written before, empty where there is none.
    [[nodiscard]] std::vector<std::uint8_t> read(std::string_view name) const;
    /// Removes the files whose names end like this.
    void remove(std::string_view suffix);

    /// Puts the folder in its place in one step and returns where it is.
    std::filesystem::path publish();

  private:
    std::filesystem::path wanted_;
    std::filesystem::path temporary_;
    std::filesystem::path made_parent_; ///< outermost parent made for the folder
    bool published_ = false;
    bool kept_ = false;
};

/// Name of a PNG file of these parts; characters that file systems treat apart are replaced.
std::string picture_name(std::initializer_list<std::string> parts);

} // namespace lab
