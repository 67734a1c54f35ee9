#include "perf/csv.h"

#include <nlohmann/json.hpp>

namespace slabcast {

namespace {

using nlohmann::json;

std::string quoted(std::string text) {
    if (text.find_first_of(",\"\n") == std::string::npos) {
        return text;
    }
    for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) {
        text.insert(at, 1, '"');
    }
    return '"' + text + '"';
}

std::string cellOf(const json& row, const char* pointer) {
    const json::json_pointer place(pointer);
    const json value = row.contains(place) ? row.at(place) : json();
    return value.is_null()     ? ""
           : value.is_string() ? quoted(value.get<std::string>())
                               : value.dump();
}

} // namespace

std::vector<CsvColumn> columnsOf(std::initializer_list<std::span<const CsvColumn>> parts) {
    std::vector<CsvColumn> columns;
    for (const std::span<const CsvColumn> part : parts) {
        columns.insert(columns.end(), part.begin(), part.end());
    }
    return columns;
}

std::string csvOf(const json& rows, std::span<const CsvColumn> columns) {
    std::string text;
    const auto endLine = [&text] { text.back() = '\n'; };
    for (const CsvColumn& column : columns) {
        text += std::string(column.heading) + ",";
    }
    endLine();
    for (const json& row : rows) {
        for (const CsvColumn& column : columns) {
            text += cellOf(row, column.pointer) + ",";
        }
        endLine();
    }
    return text;
}

} // namespace slabcast
