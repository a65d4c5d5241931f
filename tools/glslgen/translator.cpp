// What is translated, from the roots on, and in which order it stands.
#include "translator_class.hpp"

namespace glslgen {

void translator::add_root(const Decl* declaration, SourceLocation where) {
    if (const auto* function = dyn_cast<FunctionDecl>(declaration)) {
        if (annotation(function, "glsl:")) {
            return;
        }
        require_function(function, where);
    } else if (const auto* record = dyn_cast<CXXRecordDecl>(declaration)) {
        if (annotation(record, "glsl_type:")) {
            return;
        }
        frames_.push_back({record->getQualifiedNameAsString(), where, {}, nullptr, {}, {}});
        require_structure(record, where);
        frames_.pop_back();
        if (record->getDefinition() == nullptr) {
            return;
        }
        for (const CXXMethodDecl* method : record->getDefinition()->methods()) {
            const FunctionDecl* definition = nullptr;
            if (method->isImplicit() || method->isDefaulted() || method->isDeleted() ||
                isa<CXXConstructorDecl>(method) || isa<CXXDestructorDecl>(method) ||
                method->getAccess() == AS_private || !method->hasBody(definition)) {
                continue;
            }
            require_function(method, where);
        }
    } else if (const auto* enumeration = dyn_cast<EnumDecl>(declaration)) {
        frames_.push_back({enumeration->getQualifiedNameAsString(), where, {}, nullptr, {}, {}});
        require_enumeration(enumeration, where);
        frames_.pop_back();
    } else if (const auto* variable = dyn_cast<VarDecl>(declaration)) {
        frames_.push_back({variable->getQualifiedNameAsString(), where, {}, nullptr, {}, {}});
        require_constant(variable, where);
        frames_.pop_back();
    }
}

bool translator::run(translation& result) {
    const FileID main = sources_.getMainFileID();
    struct root {
        unsigned at;
        const Decl* declaration;
        SourceLocation where;
    };
    std::vector<root> roots;
    const auto add = [&](const Decl* declaration, SourceLocation where) {
        where = sources_.getExpansionLoc(where);
        if (sources_.getFileID(where) == main) {
            roots.push_back({offset(where), declaration, where});
        }
    };
    std::function<void(const DeclContext*)> walk = [&](const DeclContext* context) {
        for (const Decl* each : context->decls()) {
            if (const auto* space = dyn_cast<NamespaceDecl>(each)) {
                if (!space->isStdNamespace() && space->getName() != "glm") {
                    walk(space);
                }
            } else if (const auto* linkage = dyn_cast<LinkageSpecDecl>(each)) {
                static_cast<void>(linkage);
            } else if (const auto* function = dyn_cast<FunctionTemplateDecl>(each)) {
                for (const FunctionDecl* special : function->specializations()) {
                    if (special->getTemplateSpecializationKind() ==
                        TSK_ExplicitInstantiationDefinition) {
                        add(special, special->getPointOfInstantiation());
                    }
                }
            } else if (const auto* record = dyn_cast<ClassTemplateDecl>(each)) {
                for (const ClassTemplateSpecializationDecl* special : record->specializations()) {
                    if (special->getSpecializationKind() == TSK_ExplicitInstantiationDefinition) {
                        add(special, special->getPointOfInstantiation());
                    }
                }
            } else if (const auto* variable = dyn_cast<VarTemplateDecl>(each)) {
                for (const VarTemplateSpecializationDecl* special : variable->specializations()) {
                    if (special->getSpecializationKind() == TSK_ExplicitInstantiationDefinition) {
                        add(special, special->getPointOfInstantiation());
                    }
                }
            } else if (const auto* use = dyn_cast<UsingDecl>(each)) {
                for (const UsingShadowDecl* shadow : use->shadows()) {
                    add(shadow->getTargetDecl(), use->getLocation());
                }
            } else if (isa<ClassTemplateSpecializationDecl>(each) ||
                       isa<VarTemplateSpecializationDecl>(each)) {
                // found through their templates
            } else if (isa<CXXRecordDecl>(each)) {
                const auto* definition = clang::cast<CXXRecordDecl>(each);
                if (definition->isThisDeclarationADefinition() && !definition->isImplicit()) {
                    add(definition, definition->getLocation());
                }
            } else if (isa<FunctionDecl>(each)) {
                const auto* definition = clang::cast<FunctionDecl>(each);
                if (definition->isThisDeclarationADefinition() && !definition->isDeleted() &&
                    !definition->isTemplateInstantiation() &&
                    !(definition->isOverloadedOperator() && is_bit_operator(definition))) {
                    add(definition, definition->getLocation());
                }
            } else if (const auto* enumeration = dyn_cast<EnumDecl>(each)) {
                add(enumeration, enumeration->getLocation());
            } else if (const auto* constant = dyn_cast<VarDecl>(each)) {
                if (constant->isConstexpr()) {
                    add(constant, constant->getLocation());
                }
            }
        }
    };
    walk(context_.getTranslationUnitDecl());
    std::stable_sort(roots.begin(), roots.end(),
                     [](const root& a, const root& b) { return a.at < b.at; });
    if (roots.empty()) {
        DiagnosticsEngine& engine = context_.getDiagnostics();
        engine.Report(sources_.getLocForStartOfFile(main),
                      engine.getCustomDiagID(DiagnosticsEngine::Error, "%0"))
            << "nothing is shared here: no explicit instantiation, definition or "
               "using-declaration";
        return false;
    }
    for (const root& each : roots) {
        if (const auto* templated = dyn_cast<FunctionTemplateDecl>(each.declaration)) {
            refuse(each.where, "'" + templated->getName().str() +
                                   "' is a template: name it by an explicit instantiation");
        } else if (const auto* class_template = dyn_cast<ClassTemplateDecl>(each.declaration)) {
            refuse(each.where, "'" + class_template->getName().str() +
                                   "' is a template: name it by an explicit instantiation");
        } else {
            add_root(each.declaration, each.where);
        }
    }
    if (!failed_) {
        check_signatures();
    }
    return !failed_ && order(result);
}

// Two functions of one name must differ in their parameters, or GLSL takes them for one.
void translator::check_signatures() {
    std::map<std::string, const entity*> seen;
    for (const entity& each : entities_) {
        std::string key = each.name;
        if (each.kind == entity_kind::function) {
            key += "(";
            for (const variable& parameter : each.variables) {
                key += parameter.type + "[" + std::to_string(parameter.array) + "],";
            }
        }
        const auto [found, is_new] = seen.emplace(key, &each);
        if (!is_new) {
            DiagnosticsEngine& engine = context_.getDiagnostics();
            engine.Report(engine.getCustomDiagID(DiagnosticsEngine::Error, "%0"))
                << "'" + found->second->cpp_name + "' and '" + each.cpp_name +
                       "' would both become '" + key + "' in GLSL";
            failed_ = true;
        }
    }
}

bool translator::order(translation& result) {
    // topics in the order in which they need each other, then as they stand in their headers
    std::map<std::string, std::set<std::string>> needs;
    std::vector<std::string> names;
    for (const entity& each : entities_) {
        if (std::find(names.begin(), names.end(), each.topic) == names.end()) {
            names.push_back(each.topic);
        }
        for (const std::size_t used : each.dependencies) {
            if (entities_[used].topic != each.topic) {
                needs[each.topic].insert(entities_[used].topic);
            }
        }
    }
    std::sort(names.begin(), names.end());
    std::vector<std::string> topics;
    std::set<std::string> open;
    std::set<std::string> done;
    bool cyclic = false;
    std::function<void(const std::string&)> visit_topic = [&](const std::string& topic) {
        if (done.count(topic) != 0) {
            return;
        }
        if (!open.insert(topic).second) {
            cyclic = true;
            return;
        }
        for (const std::string& each : needs[topic]) {
            visit_topic(each);
        }
        open.erase(topic);
        done.insert(topic);
        topics.push_back(topic);
    };
    for (const std::string& each : names) {
        visit_topic(each);
    }
    if (cyclic) {
        DiagnosticsEngine& engine = context_.getDiagnostics();
        engine.Report(engine.getCustomDiagID(DiagnosticsEngine::Error, "%0"))
            << "two headers need shared functions of each other";
        return false;
    }
    std::map<std::string, std::size_t> rank;
    for (std::size_t i = 0; i < topics.size(); ++i) {
        rank[topics[i]] = i;
    }
    std::vector<std::size_t> indices(entities_.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        indices[i] = i;
    }
    std::stable_sort(indices.begin(), indices.end(), [&](std::size_t a, std::size_t b) {
        const auto key = [&](std::size_t i) {
            return std::pair(rank[entities_[i].topic], entities_[i].offset);
        };
        return key(a) < key(b);
    });
    std::vector<std::size_t> place(entities_.size());
    std::vector<bool> placed(entities_.size(), false);
    std::vector<entity> ordered;
    std::function<void(std::size_t)> visit = [&](std::size_t i) {
        if (placed[i]) {
            return;
        }
        placed[i] = true;
        std::vector<std::size_t> used = entities_[i].dependencies;
        std::sort(used.begin(), used.end(), [&](std::size_t a, std::size_t b) {
            return std::pair(rank[entities_[a].topic], entities_[a].offset) <
                   std::pair(rank[entities_[b].topic], entities_[b].offset);
        });
        for (const std::size_t each : used) {
            visit(each);
        }
        place[i] = ordered.size();
        ordered.push_back(entities_[i]);
    };
    for (const std::size_t i : indices) {
        visit(i);
    }
    for (entity& each : ordered) {
        for (std::size_t& used : each.dependencies) {
            used = place[used];
        }
        std::sort(each.dependencies.begin(), each.dependencies.end());
    }
    result.entities = std::move(ordered);
    result.topics = std::move(topics);
    return true;
}

namespace {

class consumer : public ASTConsumer {
  public:
    consumer(const translation_options& options, translation& result, bool& good)
        : options_(options), result_(result), good_(good) {}

    void HandleTranslationUnit(ASTContext& context) override {
        if (context.getDiagnostics().hasErrorOccurred()) {
            return;
        }
        translator work(context, options_);
        translation made;
        if (!work.run(made)) {
            return;
        }
        SourceManager& sources = context.getSourceManager();
        std::set<std::string> inputs;
        for (auto each = sources.fileinfo_begin(); each != sources.fileinfo_end(); ++each) {
            const auto file = each->first;
            const FileID id = sources.translateFile(file);
            if (id.isInvalid() || sources.isInSystemHeader(sources.getLocForStartOfFile(id))) {
                continue;
            }
            inputs.insert(sources.getFilename(sources.getLocForStartOfFile(id)).str());
        }
        made.inputs.assign(inputs.begin(), inputs.end());
        result_ = std::move(made);
        good_ = true;
    }

  private:
    const translation_options& options_;
    translation& result_;
    bool& good_;
};

class action : public ASTFrontendAction {
  public:
    action(const translation_options& options, translation& result, bool& good)
        : options_(options), result_(result), good_(good) {}

    std::unique_ptr<ASTConsumer> CreateASTConsumer(CompilerInstance&, StringRef) override {
        return std::make_unique<consumer>(options_, result_, good_);
    }

  private:
    const translation_options& options_;
    translation& result_;
    bool& good_;
};

} // namespace

bool translate(const translation_options& options, translation& result) {
    bool good = false;
    std::vector<std::string> command{"warpshadow-glslgen",
                                     "-fsyntax-only",
                                     "-x",
                                     "c++",
                                     "-std=c++20",
                                     "-DNDEBUG",
                                     "-DWARPSHADOW_GLSLGEN",
                                     "-Wno-unused",
                                     "-Wno-parentheses",
                                     "-Wno-unsequenced",
                                     "-ferror-limit=100",
                                     "-Wno-pragma-once-outside-header"};
    if (!options.resource_folder.empty()) {
        command.push_back("-resource-dir=" + options.resource_folder);
    }
    command.insert(command.end(), options.flags.begin(), options.flags.end());
    command.push_back(options.source);
    llvm::IntrusiveRefCntPtr<FileManager> files(new FileManager(FileSystemOptions()));
    tooling::ToolInvocation invocation(command, std::make_unique<action>(options, result, good),
                                       files.get());
    const bool ran = invocation.run();
    return ran && good;
}

} // namespace glslgen
