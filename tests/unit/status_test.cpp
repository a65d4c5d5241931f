// Plain cases of warpshadow/status.hpp.
#include <warpshadow/status.hpp>

#include <catch2/catch.hpp>

#include <cstdint>
#include <set>
#include <string>

using namespace warpshadow;

namespace {

status guard(int i) {
    return static_cast<status>(std::uint32_t(1) << i);
}

} // namespace

TEST_CASE("every guard has a name of its own") {
    std::set<std::string> names;
    for (int i = 0; i < status_count; ++i) {
        const std::string name = status_name(guard(i));
        CAPTURE(i, name);
        CHECK(name != "unknown");
        CHECK(name != "ok");
        CHECK(names.insert(name).second);
    }
    CHECK(std::string(status_name(status::ok)) == "ok");
}

TEST_CASE("status_count counts all guards") {
    for (int i = status_count; i < 32; ++i) {
        CAPTURE(i);
        CHECK(std::string(status_name(guard(i))) == "unknown");
    }
    CHECK(std::string(status_name(guard(0) | guard(1))) == "unknown");
}

TEST_CASE("guards are united, intersected and asked for") {
    constexpr status both = status::near_clamped | status::unbounded;
    static_assert(any(both, status::near_clamped));
    static_assert(any(both, status::unbounded));
    static_assert(!any(both, status::invalid_input));
    static_assert(any(both, status::invalid_input | status::unbounded));
    static_assert((both & status::unbounded) == status::unbounded);
    static_assert((both & status::empty_rows) == status::ok);
    static_assert(!any(status::ok, both));
    static_assert(!any(both, status::ok));
    for (int i = 0; i < status_count; ++i) {
        for (int j = 0; j < status_count; ++j) {
            status flags = guard(i);
            flags |= guard(j);
            CHECK(flags == (guard(j) | guard(i)));
            CHECK(any(flags, guard(i)));
            CHECK(any(flags, guard(j)));
            CHECK(any(guard(i), guard(j)) == (i == j));
        }
    }
}
