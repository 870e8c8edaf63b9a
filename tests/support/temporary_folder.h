#pragma once
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <stdlib.h>

#include "engine/core/contract.h"

namespace palp {

/// A new folder that is removed with the object.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "palp_test_XXXXXX").string();
        if (!::mkdtemp(name.data())) throw Error("no temporary folder");
        path_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&)            = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    [[nodiscard]] std::filesystem::path        operator/(const std::string& name) const { return path_ / name; }

    /// Writes a file into the folder and returns its path.
    [[nodiscard]] std::filesystem::path write(const std::string& name, std::string_view bytes) const
    {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

inline std::string contentsOf(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the sentence of the Error that `act` throws; empty if it throws none.
template <class Act>
std::string refusalOf(const Act& act)
{
    try {
        act();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

/// Returns true if a sentence contains all of the words; for EXPECT_TRUE(...) << sentence.
inline bool holds(std::string_view sentence, std::initializer_list<std::string_view> words)
{
    for (const std::string_view word : words)
        if (sentence.find(word) == std::string_view::npos) return false;
    return true;
}

} // namespace palp
