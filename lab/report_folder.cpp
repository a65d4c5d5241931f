#include "lab/report_folder.hpp"

#include "lab/scene.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

namespace lab {
namespace {

namespace fs = std::filesystem;

bool is_report_file(const fs::path& file) {
    const std::string name = file.filename().string();
    return name == "results.json" || name == "report.html" || file.extension() == ".png";
}

/// Whether a folder holds a report and nothing else, so that a new one may take its place.
bool may_be_replaced(const fs::path& folder) {
    bool empty = true;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        empty = false;
        if (!entry.is_regular_file() || entry.is_symlink() || !is_report_file(entry.path())) {
            return false;
        }
    }
    return empty || fs::exists(folder / "results.json");
}

/// Removes the folders from `innermost` up to `outermost`, which were made here, if still empty.
void remove_empty_parents(fs::path innermost, const fs::path& outermost) {
    std::error_code error;
    while (!outermost.empty() && fs::remove(innermost, error) && innermost != outermost) {
        innermost = innermost.parent_path();
    }
}

[[noreturn]] void refuse(const fs::path& folder, const std::string& reason) {
    throw bad_input("cannot write the report to '" + folder.string() + "': " + reason);
}

} // namespace

report_folder::report_folder(const fs::path& wanted, bool resumable) {
    std::error_code error;
    wanted_ = fs::absolute(wanted).lexically_normal();
    if (!wanted_.has_filename()) {
        wanted_ = wanted_.parent_path(); // a slash at the end
    }
    if (wanted_ == wanted_.root_path()) {
        refuse(wanted, "it is the root folder");
    }
    const fs::file_status there = fs::symlink_status(wanted_, error);
    if (fs::exists(there)) {
        if (!fs::is_directory(there)) {
            refuse(wanted, "it exists and is not a folder");
        }
        bool replace = false;
        try {
            replace = may_be_replaced(wanted_);
        } catch (const fs::filesystem_error& failure) {
            refuse(wanted, failure.code().message());
        }
        if (!replace) {
            refuse(wanted, "the folder holds something other than a report");
        }
    }
    const fs::path parent = wanted_.parent_path();
    for (fs::path each = parent; !fs::exists(each, error) && each != each.root_path();
         each = each.parent_path()) {
        made_parent_ = each;
    }
    const auto give_up = [&](const std::error_code& why) {
        remove_empty_parents(parent, made_parent_);
        refuse(wanted, why.message());
    };
    fs::create_directories(parent, error);
    if (error) {
        give_up(error);
    }
    std::string name = ".";
    name += wanted_.filename().string();
    name += resumable ? ".unfinished" : ".partial-" + std::to_string(static_cast<long>(::getpid()));
    temporary_ = parent / name;
    if (!resumable) {
        fs::remove_all(temporary_, error);
    }
    const bool made = fs::create_directory(temporary_, error);
    if (error || !(made || resumable)) {
        give_up(error ? error : std::make_error_code(std::errc::file_exists));
    }
    // some file systems make folders and refuse files
    std::ofstream probe(temporary_ / "results.json");
    if (!(probe << "{}\n") || !probe.flush()) {
        const int code = errno;
        fs::remove_all(temporary_, error);
        give_up(std::error_code(code, std::generic_category()));
    }
}

report_folder::~report_folder() {
    if (!published_ && !kept_) {
        std::error_code ignored;
        fs::remove_all(temporary_, ignored);
        remove_empty_parents(wanted_.parent_path(), made_parent_);
    }
}

void report_folder::write(std::string_view name, std::span<const std::uint8_t> bytes) {
    std::ofstream file(temporary_ / name, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) {
        refuse(wanted_, std::string(name) + ": " + std::strerror(errno));
    }
}

void report_folder::write(std::string_view name, const std::string& text) {
    write(name, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::vector<std::uint8_t> report_folder::read(std::string_view name) const {
    std::ifstream file(temporary_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void report_folder::remove(std::string_view suffix) {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(temporary_)) {
        if (entry.path().filename().string().ends_with(suffix)) {
            found.push_back(entry.path());
        }
    }
    std::for_each(found.begin(), found.end(), [](const fs::path& file) { fs::remove(file); });
}

fs::path report_folder::publish() {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(wanted_, error))) {
        fs::rename(temporary_, wanted_);
    } else {
        // both names are valid at any moment: the folders change places, then the old one goes
        if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, wanted_.c_str(), RENAME_EXCHANGE) !=
            0) {
            // a file system without that call: the old report goes a moment before
            fs::remove_all(wanted_);
            fs::rename(temporary_, wanted_);
        } else {
            fs::remove_all(temporary_, error);
        }
    }
    published_ = true;
    return wanted_;
}

std::string picture_name(std::initializer_list<std::string> parts) {
    std::string name;
    for (const std::string& part : parts) {
        name += name.empty() ? "" : "-";
        for (const char c : part) {
            const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' ||
                               c == '-' || c == '_';
            name += plain ? c : '_';
        }
    }
    return name + ".png";
}

} // namespace lab
