#include "perf/model/predict_json.h"

namespace slabcast {

Json toJson(std::span<const Prediction> predictions) {
    Json all = Json::object();
    for (const Prediction& one : predictions) {
        const ModelTerms& t = one.terms;
        all[one.gpu->name] = {{"device", one.gpu->title},
                              {"variant", name(one.plan.variant)},
                              {"frame_ms", t.frameMs},
                              {"low_ms", t.lowMs},
                              {"high_ms", t.highMs},
                              {"limit", t.limit},
                              {"issue_ms", t.issueMs},
                              {"texture_ms", t.textureMs},
                              {"fragment_ms", t.fragmentMs},
                              {"blend_ms", t.blendMs},
                              {"tile_ms", t.tileMs},
                              {"memory_ms", t.memoryMs},
                              {"divergence_ms", t.divergenceMs},
                              {"code_low_ms", t.codeLowMs},
                              {"code_high_ms", t.codeHighMs},
                              {"layer_divergence", one.work.layerDivergence},
                              {"look_divergence", one.work.lookDivergence}};
    }
    return all;
}

} // namespace slabcast
