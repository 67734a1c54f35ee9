#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slabcast {

/// What a report says and what a cached table holds: null, true or false, a number, text, a list,
/// or an object, whose members are sorted by name. nlohmann-json reads and writes it, in one
/// source: each source that parsed its header took 8 s to compile where others take 2. Nothing here
/// fails: what is not there is null, and what is of another kind than asked for is false, 0 or
/// empty. Tested by: json_test.cpp
class Json {
public:
    struct Member;

    Json(); // null
    Json(std::nullptr_t);
    Json(bool value);
    Json(int value) : Json(static_cast<long long>(value)) {}
    Json(long value) : Json(static_cast<long long>(value)) {}
    Json(long long value);
    Json(unsigned value) : Json(static_cast<unsigned long long>(value)) {}
    Json(unsigned long value) : Json(static_cast<unsigned long long>(value)) {}
    Json(unsigned long long value);
    Json(double value);
    Json(const char* text);
    Json(std::string_view text);
    Json(std::string text);
    Json(const void*) = delete; // would be true or false
    /// An object. Of two members of one name the last counts.
    Json(std::initializer_list<Member> members);
    static Json object(); // without members
    static Json list(std::initializer_list<Json> items = {});
    /// Of whatever can be iterated over.
    template <class Items>
    static Json listOf(const Items& items) {
        Json all = list();
        for (const auto& item : items) {
            all.push_back(Json(item));
        }
        return all;
    }
    Json(const Json&);
    Json(Json&&) noexcept;
    Json& operator=(const Json&);
    Json& operator=(Json&&) noexcept;
    ~Json();

    /// Nothing of text that is no JSON, or of lists and objects more than 100 deep.
    static std::optional<Json> parse(std::string_view text);
    /// On one line, or indented by so many spaces a level. NaN and infinity are written as null,
    /// what is not UTF-8 as U+FFFD.
    std::string dump(int indent = -1) const;

    bool isNull() const { return kind_ == Kind::Null; }
    bool isBool() const { return kind_ == Kind::Bool; }
    bool isWhole() const { return kind_ == Kind::Signed || kind_ == Kind::Unsigned; }
    bool isNumber() const { return isWhole() || kind_ == Kind::Real; }
    bool isText() const { return kind_ == Kind::Text; }
    bool isList() const { return kind_ == Kind::List; }
    bool isObject() const { return kind_ == Kind::Object; }

    bool flag() const { return isBool() && whole_ != 0; }
    std::int64_t whole() const { return isWhole() ? whole_ : 0; }
    double number() const;
    const std::string& text() const { return text_; }

    // Of lists and objects; of an object, what is iterated over is its members' values.
    std::size_t size() const { return items_.size(); }
    bool empty() const { return items_.empty(); }
    const Json* begin() const { return items_.data(); }
    const Json* end() const { return items_.data() + items_.size(); }
    Json* begin() { return items_.data(); }
    Json* end() { return items_.data() + items_.size(); }

    const Json& at(std::size_t index) const;
    Json& operator[](std::size_t index) { return items_[index]; } // contract: it is there
    /// Contract: a list, or null, which becomes one.
    void push_back(Json item);

    bool contains(std::string_view name) const { return find(name) != nullptr; }
    const Json& at(std::string_view name) const;
    /// Makes the member if it is not there: then others move. Contract: an object, or null, which
    /// becomes one.
    Json& operator[](std::string_view name);
    /// Sets all members of another object.
    void update(Json members);
    void erase(std::string_view name);
    /// Of the members, in their order.
    const std::vector<std::string>& names() const { return names_; }

    /// Where a JSON pointer leads, as "/rows/0/id"; a null pointer where nothing is. It reaches no
    /// name that holds '/' or '~'.
    const Json* atPointer(std::string_view pointer) const;

    /// 1 equals 1.0, and no number equals true.
    friend bool operator==(const Json& a, const Json& b);

private:
    enum class Kind : std::uint8_t { Null, Bool, Signed, Unsigned, Real, Text, List, Object };

    struct Library;

    const Json* find(std::string_view name) const;

    Kind kind_ = Kind::Null;
    std::int64_t whole_ = 0; // of a bool too; of an unsigned number its bits
    double real_ = 0.0;
    std::string text_;
    std::vector<std::string> names_; // one for each item of an object, sorted
    std::vector<Json> items_;
};

/// `{"name", value}` in a braced list of members.
struct Json::Member {
    std::string_view name;
    mutable Json value; // the object takes it
};

} // namespace slabcast
