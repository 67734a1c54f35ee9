#include "perf/json.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

namespace slabcast {

namespace {

constexpr int kMostLevels = 100;
constexpr std::size_t kMostDigits = 9; // of an index: fits any size_t

const Json& null() {
    static const Json none;
    return none;
}

/// Where this name is or would be.
std::size_t placeOf(const std::vector<std::string>& names, std::string_view name) {
    return static_cast<std::size_t>(std::lower_bound(names.begin(), names.end(), name) -
                                    names.begin());
}

/// Nothing where these are not digits alone.
std::optional<std::size_t> indexOf(std::string_view digits) {
    std::size_t index = 0;
    for (const char digit : digits) {
        if (digit < '0' || digit > '9') {
            return std::nullopt;
        }
        index = 10 * index + static_cast<std::size_t>(digit - '0');
    }
    return digits.empty() || digits.size() > kMostDigits ? std::nullopt : std::optional(index);
}

} // namespace

/// To and from the values of nlohmann-json.
struct Json::Library {
    using Value = nlohmann::json;

    static Value written(const Json& value) {
        switch (value.kind_) {
        case Kind::Null:
            break;
        case Kind::Bool:
            return value.flag();
        case Kind::Signed:
            return value.whole_;
        case Kind::Unsigned:
            return static_cast<std::uint64_t>(value.whole_);
        case Kind::Real:
            return value.real_;
        case Kind::Text:
            return value.text_;
        case Kind::List:
            return listWritten(value);
        case Kind::Object:
            return objectWritten(value);
        }
        return nullptr;
    }

    /// Nothing where there are more levels than these.
    static std::optional<Json> read(const Value& value, int levels) {
        switch (value.type()) {
        case Value::value_t::boolean:
            return Json(value.get<bool>());
        case Value::value_t::number_integer:
            return Json(static_cast<long long>(value.get<std::int64_t>()));
        case Value::value_t::number_unsigned:
            return Json(static_cast<unsigned long long>(value.get<std::uint64_t>()));
        case Value::value_t::number_float:
            return Json(value.get<double>());
        case Value::value_t::string:
            return Json(value.get_ref<const std::string&>());
        case Value::value_t::array:
        case Value::value_t::object:
            return levels == 0 ? std::nullopt : itemsRead(value, levels - 1);
        default:
            return Json();
        }
    }

private:
    static Value listWritten(const Json& list) {
        Value result = Value::array();
        for (const Json& item : list.items_) {
            result.push_back(written(item));
        }
        return result;
    }

    static Value objectWritten(const Json& object) {
        Value result = Value::object();
        for (std::size_t i = 0; i < object.size(); ++i) {
            result[object.names_[i]] = written(object.items_[i]);
        }
        return result;
    }

    /// Of a list, or of an object: its names are sorted already.
    static std::optional<Json> itemsRead(const Value& value, int levels) {
        Json result = value.is_object() ? object() : list();
        for (auto item = value.begin(); item != value.end(); ++item) {
            std::optional<Json> one = read(*item, levels);
            if (!one) {
                return std::nullopt;
            }
            if (value.is_object()) {
                result.names_.push_back(item.key());
            }
            result.items_.push_back(std::move(*one));
        }
        return result;
    }
};

Json::Json() = default;
Json::Json(std::nullptr_t) : Json() {}
Json::Json(bool value) : kind_(Kind::Bool), whole_(value ? 1 : 0) {}
Json::Json(long long value) : kind_(Kind::Signed), whole_(value) {}
Json::Json(unsigned long long value)
    : kind_(Kind::Unsigned), whole_(static_cast<std::int64_t>(value)) {}
Json::Json(double value) : kind_(Kind::Real), real_(value) {}
Json::Json(const char* text) : kind_(Kind::Text), text_(text) {}
Json::Json(std::string_view text) : kind_(Kind::Text), text_(text) {}
Json::Json(std::string text) : kind_(Kind::Text), text_(std::move(text)) {}
Json::Json(const Json&) = default;
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(const Json&) = default;
Json& Json::operator=(Json&&) noexcept = default;
Json::~Json() = default;

Json::Json(std::initializer_list<Member> members) : kind_(Kind::Object) {
    names_.reserve(members.size());
    items_.reserve(members.size());
    for (const Member& member : members) {
        (*this)[member.name] = std::move(member.value);
    }
}

Json Json::object() {
    Json result;
    result.kind_ = Kind::Object;
    return result;
}

Json Json::list(std::initializer_list<Json> items) {
    Json result;
    result.kind_ = Kind::List;
    result.items_ = items;
    return result;
}

std::optional<Json> Json::parse(std::string_view text) {
    const Library::Value value = Library::Value::parse(text, nullptr, false);
    return value.is_discarded() ? std::nullopt : Library::read(value, kMostLevels);
}

std::string Json::dump(int indent) const {
    return Library::written(*this).dump(indent, ' ', false,
                                        Library::Value::error_handler_t::replace);
}

double Json::number() const {
    return kind_ == Kind::Unsigned ? static_cast<double>(static_cast<std::uint64_t>(whole_))
           : kind_ == Kind::Signed ? static_cast<double>(whole_)
                                   : real_;
}

const Json& Json::at(std::size_t index) const {
    return index < items_.size() ? items_[index] : null();
}

void Json::push_back(Json item) {
    kind_ = Kind::List;
    items_.push_back(std::move(item));
}

const Json* Json::find(std::string_view name) const {
    const std::size_t place = placeOf(names_, name);
    return place < names_.size() && names_[place] == name ? &items_[place] : nullptr;
}

const Json& Json::at(std::string_view name) const {
    const Json* found = find(name);
    return found == nullptr ? null() : *found;
}

Json& Json::operator[](std::string_view name) {
    kind_ = Kind::Object;
    const std::size_t place = placeOf(names_, name);
    if (place == names_.size() || names_[place] != name) {
        const auto offset = static_cast<std::ptrdiff_t>(place);
        names_.emplace(names_.begin() + offset, name);
        items_.emplace(items_.begin() + offset);
    }
    return items_[place];
}

void Json::update(Json members) {
    kind_ = Kind::Object;
    for (std::size_t i = 0; i < members.names_.size(); ++i) {
        (*this)[members.names_[i]] = std::move(members.items_[i]);
    }
}

void Json::erase(std::string_view name) {
    if (contains(name)) {
        const auto offset = static_cast<std::ptrdiff_t>(placeOf(names_, name));
        names_.erase(names_.begin() + offset);
        items_.erase(items_.begin() + offset);
    }
}

const Json* Json::atPointer(std::string_view pointer) const {
    const Json* place = this;
    while (place != nullptr && !pointer.empty()) {
        if (pointer.front() != '/') {
            return nullptr;
        }
        const std::string_view step = pointer.substr(1, pointer.find('/', 1) - 1);
        pointer.remove_prefix(1 + step.size());
        if (place->isList()) {
            const std::optional<std::size_t> index = indexOf(step);
            place = index && *index < place->size() ? &place->items_[*index] : nullptr;
        } else {
            place = place->find(step);
        }
    }
    return place;
}

bool operator==(const Json& a, const Json& b) {
    if (a.isNumber() && b.isNumber()) {
        return a.isWhole() && b.isWhole() ? a.whole_ == b.whole_ : a.number() == b.number();
    }
    return a.kind_ == b.kind_ && a.whole_ == b.whole_ && a.text_ == b.text_ &&
           a.names_ == b.names_ && a.items_ == b.items_;
}

} // namespace slabcast
