#pragma once

// The GL functions that are loaded, as X-macros over (name without `gl`, its spelling in PFNGL...PROC).

// clang-format off
// State.
#define SLABCAST_GL_STATE(X)                                                                      \
    X(ActiveTexture, ACTIVETEXTURE) X(BlendBarrier, BLENDBARRIER) X(BlendColor, BLENDCOLOR)       \
    X(BlendEquation, BLENDEQUATION) X(BlendEquationSeparate, BLENDEQUATIONSEPARATE)               \
    X(BlendEquationSeparatei, BLENDEQUATIONSEPARATEI) X(BlendEquationi, BLENDEQUATIONI)           \
    X(BlendFunc, BLENDFUNC) X(BlendFuncSeparate, BLENDFUNCSEPARATE)                               \
    X(BlendFuncSeparatei, BLENDFUNCSEPARATEI) X(BlendFunci, BLENDFUNCI) X(ColorMask, COLORMASK)   \
    X(ColorMaski, COLORMASKI) X(CullFace, CULLFACE) X(DepthFunc, DEPTHFUNC)                       \
    X(DepthMask, DEPTHMASK) X(DepthRangef, DEPTHRANGEF) X(Disable, DISABLE) X(Disablei, DISABLEI) \
    X(Enable, ENABLE) X(Enablei, ENABLEI) X(FrontFace, FRONTFACE) X(Hint, HINT)                   \
    X(IsEnabled, ISENABLED) X(IsEnabledi, ISENABLEDI) X(LineWidth, LINEWIDTH)                     \
    X(PixelStorei, PIXELSTOREI) X(PolygonOffset, POLYGONOFFSET) X(SampleCoverage, SAMPLECOVERAGE) \
    X(SampleMaski, SAMPLEMASKI) X(Scissor, SCISSOR) X(StencilFunc, STENCILFUNC)                   \
    X(StencilFuncSeparate, STENCILFUNCSEPARATE) X(StencilMask, STENCILMASK)                       \
    X(StencilMaskSeparate, STENCILMASKSEPARATE) X(StencilOp, STENCILOP)                           \
    X(StencilOpSeparate, STENCILOPSEPARATE) X(Viewport, VIEWPORT) X(GetBooleanv, GETBOOLEANV)     \
    X(GetBooleani_v, GETBOOLEANI_V) X(GetError, GETERROR) X(GetFloatv, GETFLOATV)                 \
    X(GetGraphicsResetStatus, GETGRAPHICSRESETSTATUS) X(GetIntegerv, GETINTEGERV)                 \
    X(GetIntegeri_v, GETINTEGERI_V) X(GetInteger64v, GETINTEGER64V)                               \
    X(GetInteger64i_v, GETINTEGER64I_V) X(GetInternalformativ, GETINTERNALFORMATIV)               \
    X(GetPointerv, GETPOINTERV) X(GetString, GETSTRING) X(GetStringi, GETSTRINGI)

// Programs and shaders.
#define SLABCAST_GL_PROGRAMS_SHADERS(X)                                                           \
    X(AttachShader, ATTACHSHADER) X(BindAttribLocation, BINDATTRIBLOCATION)                       \
    X(CompileShader, COMPILESHADER) X(CreateProgram, CREATEPROGRAM) X(CreateShader, CREATESHADER) \
    X(DeleteProgram, DELETEPROGRAM) X(DeleteShader, DELETESHADER) X(DetachShader, DETACHSHADER)   \
    X(GetActiveUniform, GETACTIVEUNIFORM) X(GetActiveUniformBlockiv, GETACTIVEUNIFORMBLOCKIV)     \
    X(GetActiveUniformsiv, GETACTIVEUNIFORMSIV) X(GetAttribLocation, GETATTRIBLOCATION)           \
    X(GetFragDataLocation, GETFRAGDATALOCATION) X(GetProgramBinary, GETPROGRAMBINARY)             \
    X(GetProgramInfoLog, GETPROGRAMINFOLOG) X(GetProgramInterfaceiv, GETPROGRAMINTERFACEIV)       \
    X(GetProgramResourceIndex, GETPROGRAMRESOURCEINDEX)                                           \
    X(GetProgramResourceLocation, GETPROGRAMRESOURCELOCATION)                                     \
    X(GetProgramResourceName, GETPROGRAMRESOURCENAME)                                             \
    X(GetProgramResourceiv, GETPROGRAMRESOURCEIV) X(GetProgramiv, GETPROGRAMIV)                   \
    X(GetShaderInfoLog, GETSHADERINFOLOG) X(GetShaderPrecisionFormat, GETSHADERPRECISIONFORMAT)   \
    X(GetShaderiv, GETSHADERIV) X(GetUniformBlockIndex, GETUNIFORMBLOCKINDEX)                     \
    X(GetUniformLocation, GETUNIFORMLOCATION) X(GetUniformfv, GETUNIFORMFV)                       \
    X(GetUniformiv, GETUNIFORMIV) X(IsProgram, ISPROGRAM) X(IsShader, ISSHADER)                   \
    X(LinkProgram, LINKPROGRAM) X(ProgramBinary, PROGRAMBINARY)                                   \
    X(ProgramParameteri, PROGRAMPARAMETERI) X(ReleaseShaderCompiler, RELEASESHADERCOMPILER)       \
    X(ShaderSource, SHADERSOURCE) X(UniformBlockBinding, UNIFORMBLOCKBINDING)                     \
    X(UseProgram, USEPROGRAM) X(ValidateProgram, VALIDATEPROGRAM)

// Uniforms.
#define SLABCAST_GL_UNIFORMS(X)                                                                   \
    X(Uniform1f, UNIFORM1F) X(Uniform1fv, UNIFORM1FV) X(Uniform1i, UNIFORM1I)                     \
    X(Uniform1iv, UNIFORM1IV) X(Uniform1ui, UNIFORM1UI) X(Uniform1uiv, UNIFORM1UIV)               \
    X(Uniform2f, UNIFORM2F) X(Uniform2fv, UNIFORM2FV) X(Uniform2i, UNIFORM2I)                     \
    X(Uniform2iv, UNIFORM2IV) X(Uniform2ui, UNIFORM2UI) X(Uniform2uiv, UNIFORM2UIV)               \
    X(Uniform3f, UNIFORM3F) X(Uniform3fv, UNIFORM3FV) X(Uniform3i, UNIFORM3I)                     \
    X(Uniform3iv, UNIFORM3IV) X(Uniform3ui, UNIFORM3UI) X(Uniform3uiv, UNIFORM3UIV)               \
    X(Uniform4f, UNIFORM4F) X(Uniform4fv, UNIFORM4FV) X(Uniform4i, UNIFORM4I)                     \
    X(Uniform4iv, UNIFORM4IV) X(Uniform4ui, UNIFORM4UI) X(Uniform4uiv, UNIFORM4UIV)               \
    X(UniformMatrix2fv, UNIFORMMATRIX2FV) X(UniformMatrix3fv, UNIFORMMATRIX3FV)                   \
    X(UniformMatrix3x4fv, UNIFORMMATRIX3X4FV) X(UniformMatrix4fv, UNIFORMMATRIX4FV)               \
    X(UniformMatrix4x3fv, UNIFORMMATRIX4X3FV) X(ProgramUniform1f, PROGRAMUNIFORM1F)               \
    X(ProgramUniform1i, PROGRAMUNIFORM1I) X(ProgramUniform2f, PROGRAMUNIFORM2F)                   \
    X(ProgramUniform3fv, PROGRAMUNIFORM3FV) X(ProgramUniform4fv, PROGRAMUNIFORM4FV)               \
    X(ProgramUniformMatrix4fv, PROGRAMUNIFORMMATRIX4FV)

// Buffers and vertex arrays.
#define SLABCAST_GL_BUFFERS_VERTEX_ARRAYS(X)                                                      \
    X(BindBuffer, BINDBUFFER) X(BindBufferBase, BINDBUFFERBASE)                                   \
    X(BindBufferRange, BINDBUFFERRANGE) X(BindVertexArray, BINDVERTEXARRAY)                       \
    X(BindVertexBuffer, BINDVERTEXBUFFER) X(BufferData, BUFFERDATA)                               \
    X(BufferSubData, BUFFERSUBDATA) X(CopyBufferSubData, COPYBUFFERSUBDATA)                       \
    X(DeleteBuffers, DELETEBUFFERS) X(DeleteVertexArrays, DELETEVERTEXARRAYS)                     \
    X(DisableVertexAttribArray, DISABLEVERTEXATTRIBARRAY)                                         \
    X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY)                                           \
    X(FlushMappedBufferRange, FLUSHMAPPEDBUFFERRANGE) X(GenBuffers, GENBUFFERS)                   \
    X(GenVertexArrays, GENVERTEXARRAYS) X(GetBufferParameteri64v, GETBUFFERPARAMETERI64V)         \
    X(GetBufferParameteriv, GETBUFFERPARAMETERIV) X(IsBuffer, ISBUFFER)                           \
    X(IsVertexArray, ISVERTEXARRAY) X(MapBufferRange, MAPBUFFERRANGE) X(UnmapBuffer, UNMAPBUFFER) \
    X(VertexAttrib4f, VERTEXATTRIB4F) X(VertexAttribBinding, VERTEXATTRIBBINDING)                 \
    X(VertexAttribDivisor, VERTEXATTRIBDIVISOR) X(VertexAttribFormat, VERTEXATTRIBFORMAT)         \
    X(VertexAttribIFormat, VERTEXATTRIBIFORMAT) X(VertexAttribIPointer, VERTEXATTRIBIPOINTER)     \
    X(VertexAttribPointer, VERTEXATTRIBPOINTER) X(VertexBindingDivisor, VERTEXBINDINGDIVISOR)

// Textures and samplers.
#define SLABCAST_GL_TEXTURES_SAMPLERS(X)                                                          \
    X(BindImageTexture, BINDIMAGETEXTURE) X(BindSampler, BINDSAMPLER) X(BindTexture, BINDTEXTURE) \
    X(CompressedTexSubImage2D, COMPRESSEDTEXSUBIMAGE2D)                                           \
    X(CompressedTexSubImage3D, COMPRESSEDTEXSUBIMAGE3D) X(CopyImageSubData, COPYIMAGESUBDATA)     \
    X(CopyTexSubImage2D, COPYTEXSUBIMAGE2D) X(CopyTexSubImage3D, COPYTEXSUBIMAGE3D)               \
    X(DeleteSamplers, DELETESAMPLERS) X(DeleteTextures, DELETETEXTURES)                           \
    X(GenSamplers, GENSAMPLERS) X(GenTextures, GENTEXTURES) X(GenerateMipmap, GENERATEMIPMAP)     \
    X(GetSamplerParameteriv, GETSAMPLERPARAMETERIV)                                               \
    X(GetTexLevelParameteriv, GETTEXLEVELPARAMETERIV) X(GetTexParameteriv, GETTEXPARAMETERIV)     \
    X(IsSampler, ISSAMPLER) X(IsTexture, ISTEXTURE) X(SamplerParameterf, SAMPLERPARAMETERF)       \
    X(SamplerParameterfv, SAMPLERPARAMETERFV) X(SamplerParameteri, SAMPLERPARAMETERI)             \
    X(TexBuffer, TEXBUFFER) X(TexBufferRange, TEXBUFFERRANGE) X(TexImage2D, TEXIMAGE2D)           \
    X(TexImage3D, TEXIMAGE3D) X(TexParameterf, TEXPARAMETERF) X(TexParameterfv, TEXPARAMETERFV)   \
    X(TexParameteri, TEXPARAMETERI) X(TexStorage2D, TEXSTORAGE2D)                                 \
    X(TexStorage2DMultisample, TEXSTORAGE2DMULTISAMPLE) X(TexStorage3D, TEXSTORAGE3D)             \
    X(TexSubImage2D, TEXSUBIMAGE2D) X(TexSubImage3D, TEXSUBIMAGE3D)

// Framebuffers and pixels.
#define SLABCAST_GL_FRAMEBUFFERS_PIXELS(X)                                                        \
    X(BindFramebuffer, BINDFRAMEBUFFER) X(BindRenderbuffer, BINDRENDERBUFFER)                     \
    X(BlitFramebuffer, BLITFRAMEBUFFER) X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)         \
    X(Clear, CLEAR) X(ClearBufferfi, CLEARBUFFERFI) X(ClearBufferfv, CLEARBUFFERFV)               \
    X(ClearBufferiv, CLEARBUFFERIV) X(ClearBufferuiv, CLEARBUFFERUIV) X(ClearColor, CLEARCOLOR)   \
    X(ClearDepthf, CLEARDEPTHF) X(ClearStencil, CLEARSTENCIL)                                     \
    X(DeleteFramebuffers, DELETEFRAMEBUFFERS) X(DeleteRenderbuffers, DELETERENDERBUFFERS)         \
    X(DrawBuffers, DRAWBUFFERS) X(FramebufferParameteri, FRAMEBUFFERPARAMETERI)                   \
    X(FramebufferRenderbuffer, FRAMEBUFFERRENDERBUFFER) X(FramebufferTexture, FRAMEBUFFERTEXTURE) \
    X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)                                                 \
    X(FramebufferTextureLayer, FRAMEBUFFERTEXTURELAYER) X(GenFramebuffers, GENFRAMEBUFFERS)       \
    X(GenRenderbuffers, GENRENDERBUFFERS)                                                         \
    X(GetFramebufferAttachmentParameteriv, GETFRAMEBUFFERATTACHMENTPARAMETERIV)                   \
    X(GetRenderbufferParameteriv, GETRENDERBUFFERPARAMETERIV)                                     \
    X(InvalidateFramebuffer, INVALIDATEFRAMEBUFFER)                                               \
    X(InvalidateSubFramebuffer, INVALIDATESUBFRAMEBUFFER) X(IsFramebuffer, ISFRAMEBUFFER)         \
    X(ReadBuffer, READBUFFER) X(ReadPixels, READPIXELS) X(ReadnPixels, READNPIXELS)               \
    X(RenderbufferStorage, RENDERBUFFERSTORAGE)                                                   \
    X(RenderbufferStorageMultisample, RENDERBUFFERSTORAGEMULTISAMPLE)

// Draws and compute.
#define SLABCAST_GL_DRAWS_COMPUTE(X)                                                              \
    X(DispatchCompute, DISPATCHCOMPUTE) X(DispatchComputeIndirect, DISPATCHCOMPUTEINDIRECT)       \
    X(DrawArrays, DRAWARRAYS) X(DrawArraysIndirect, DRAWARRAYSINDIRECT)                           \
    X(DrawArraysInstanced, DRAWARRAYSINSTANCED) X(DrawElements, DRAWELEMENTS)                     \
    X(DrawElementsBaseVertex, DRAWELEMENTSBASEVERTEX)                                             \
    X(DrawElementsIndirect, DRAWELEMENTSINDIRECT) X(DrawElementsInstanced, DRAWELEMENTSINSTANCED) \
    X(DrawElementsInstancedBaseVertex, DRAWELEMENTSINSTANCEDBASEVERTEX)                           \
    X(DrawRangeElements, DRAWRANGEELEMENTS) X(MemoryBarrier, MEMORYBARRIER)                       \
    X(MemoryBarrierByRegion, MEMORYBARRIERBYREGION) X(PatchParameteri, PATCHPARAMETERI)           \
    X(PrimitiveBoundingBox, PRIMITIVEBOUNDINGBOX)

// Queries, fences and debug output.
#define SLABCAST_GL_QUERIES(X)                                                                    \
    X(BeginQuery, BEGINQUERY) X(ClientWaitSync, CLIENTWAITSYNC)                                   \
    X(DebugMessageCallback, DEBUGMESSAGECALLBACK) X(DebugMessageControl, DEBUGMESSAGECONTROL)     \
    X(DebugMessageInsert, DEBUGMESSAGEINSERT) X(DeleteQueries, DELETEQUERIES)                     \
    X(DeleteSync, DELETESYNC) X(EndQuery, ENDQUERY) X(FenceSync, FENCESYNC) X(Finish, FINISH)     \
    X(Flush, FLUSH) X(GenQueries, GENQUERIES) X(GetDebugMessageLog, GETDEBUGMESSAGELOG)           \
    X(GetObjectLabel, GETOBJECTLABEL) X(GetQueryObjectuiv, GETQUERYOBJECTUIV)                     \
    X(GetQueryiv, GETQUERYIV) X(GetSynciv, GETSYNCIV) X(IsQuery, ISQUERY) X(IsSync, ISSYNC)       \
    X(ObjectLabel, OBJECTLABEL) X(ObjectPtrLabel, OBJECTPTRLABEL) X(PopDebugGroup, POPDEBUGGROUP) \
    X(PushDebugGroup, PUSHDEBUGGROUP) X(WaitSync, WAITSYNC)

// Everything of core GLES 3.2 above: absent from no conforming driver.
#define SLABCAST_GL_FUNCTIONS(X)                                                                  \
    SLABCAST_GL_STATE(X) SLABCAST_GL_PROGRAMS_SHADERS(X)                                          \
    SLABCAST_GL_UNIFORMS(X) SLABCAST_GL_BUFFERS_VERTEX_ARRAYS(X)                                  \
    SLABCAST_GL_TEXTURES_SAMPLERS(X) SLABCAST_GL_FRAMEBUFFERS_PIXELS(X)                           \
    SLABCAST_GL_DRAWS_COMPUTE(X) SLABCAST_GL_QUERIES(X)

// Of extensions: null where the driver lacks them; gl::Caps says which may be called.
#define SLABCAST_GL_EXTENSION_FUNCTIONS(X)                                                        \
    X(FramebufferTextureMultiviewOVR, FRAMEBUFFERTEXTUREMULTIVIEWOVR)                             \
    X(GetQueryObjectui64vEXT, GETQUERYOBJECTUI64VEXT) X(QueryCounterEXT, QUERYCOUNTEREXT)         \
    X(GetQueryObjecti64vEXT, GETQUERYOBJECTI64VEXT)
// clang-format on
