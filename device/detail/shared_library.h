#pragma once
#include <string>
#include <vector>

namespace palp {

/// A library of the user's own that is opened while the program runs: Palpate neither ships it nor links to it. It is
/// never closed again, because its threads and its texts may outlive the device.
/// \thread one
class SharedLibrary {
public:
    /// Opens the first of these that there is: paths, or names that the system's loader looks for.
    /// \throws Error naming what was looked for and what each try said
    explicit SharedLibrary(const std::vector<std::string>& places);

    /// Sets a function's pointer; null if the library does not have it, which missing() then names.
    template <class Function>
    void take(const char* symbol, Function*& function)
    {
        function = reinterpret_cast<Function*>(address(symbol));
        if (!function) missing_.emplace_back(symbol);
    }

    /// Likewise, of a function without which it works too.
    template <class Function>
    void takeIfThere(const char* symbol, Function*& function)
    {
        function = reinterpret_cast<Function*>(address(symbol));
    }

    /// \throws Error naming the functions that are missing
    void demandWhole(const char* what) const;

    [[nodiscard]] const std::string& place() const noexcept { return place_; }

private:
    [[nodiscard]] void* address(const char* symbol) const noexcept;

    void*                    library_ = nullptr;
    std::string              place_;
    std::vector<std::string> missing_;
};

/// Returns the files of a folder whose names begin so, in their order; none if there is no such folder.
[[nodiscard]] std::vector<std::string> filesNamed(const std::string& folder, const std::string& begin);

/// Returns a variable of the environment; empty if it is not set.
[[nodiscard]] std::string environmentOf(const char* variable);

} // namespace palp
