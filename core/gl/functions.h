#pragma once

// The GL functions that are loaded, as X-macros over (name without `gl`, its spelling in
// PFNGL...PROC): what is called and nothing else, since a driver that lacks one of them is refused.

// clang-format off
// Of core GLES 3.2, in alphabetical order.
#define SLABCAST_GL_FUNCTIONS(X)                                                                  \
    X(ActiveTexture, ACTIVETEXTURE) X(AttachShader, ATTACHSHADER) X(BindBuffer, BINDBUFFER)       \
    X(BindBufferBase, BINDBUFFERBASE) X(BindBufferRange, BINDBUFFERRANGE)                         \
    X(BindFramebuffer, BINDFRAMEBUFFER) X(BindImageTexture, BINDIMAGETEXTURE)                     \
    X(BindRenderbuffer, BINDRENDERBUFFER) X(BindSampler, BINDSAMPLER) X(BindTexture, BINDTEXTURE) \
    X(BindVertexArray, BINDVERTEXARRAY) X(BlendEquation, BLENDEQUATION)                           \
    X(BlendEquationSeparate, BLENDEQUATIONSEPARATE) X(BlendFunc, BLENDFUNC)                       \
    X(BlendFuncSeparate, BLENDFUNCSEPARATE) X(BlitFramebuffer, BLITFRAMEBUFFER)                   \
    X(BufferData, BUFFERDATA) X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS) X(Clear, CLEAR)   \
    X(ClearBufferfv, CLEARBUFFERFV) X(ClearColor, CLEARCOLOR) X(ColorMask, COLORMASK)             \
    X(CompileShader, COMPILESHADER) X(CreateProgram, CREATEPROGRAM) X(CreateShader, CREATESHADER) \
    X(DebugMessageCallback, DEBUGMESSAGECALLBACK) X(DeleteBuffers, DELETEBUFFERS)                 \
    X(DeleteFramebuffers, DELETEFRAMEBUFFERS) X(DeleteProgram, DELETEPROGRAM)                     \
    X(DeleteRenderbuffers, DELETERENDERBUFFERS) X(DeleteSamplers, DELETESAMPLERS)                 \
    X(DeleteShader, DELETESHADER) X(DeleteTextures, DELETETEXTURES)                               \
    X(DeleteVertexArrays, DELETEVERTEXARRAYS) X(DepthFunc, DEPTHFUNC)                             \
    X(DepthMask, DEPTHMASK) X(DepthRangef, DEPTHRANGEF)                                           \
    X(DetachShader, DETACHSHADER) X(Disable, DISABLE) X(DispatchCompute, DISPATCHCOMPUTE)         \
    X(DrawArrays, DRAWARRAYS) X(DrawArraysInstanced, DRAWARRAYSINSTANCED)                         \
    X(DrawBuffers, DRAWBUFFERS) X(Enable, ENABLE)                                                 \
    X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY) X(Finish, FINISH)                         \
    X(FramebufferRenderbuffer, FRAMEBUFFERRENDERBUFFER)                                           \
    X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)                                                 \
    X(FramebufferTextureLayer, FRAMEBUFFERTEXTURELAYER) X(GenBuffers, GENBUFFERS)                 \
    X(GenFramebuffers, GENFRAMEBUFFERS) X(GenRenderbuffers, GENRENDERBUFFERS)                     \
    X(GenSamplers, GENSAMPLERS) X(GenTextures, GENTEXTURES) X(GenVertexArrays, GENVERTEXARRAYS)   \
    X(GetActiveUniform, GETACTIVEUNIFORM) X(GetBooleanv, GETBOOLEANV) X(GetError, GETERROR)       \
    X(GetFloatv, GETFLOATV) X(GetInteger64i_v, GETINTEGER64I_V) X(GetInteger64v, GETINTEGER64V)   \
    X(GetIntegeri_v, GETINTEGERI_V) X(GetIntegerv, GETINTEGERV) X(GetObjectLabel, GETOBJECTLABEL) \
    X(GetPointerv, GETPOINTERV) X(GetProgramInfoLog, GETPROGRAMINFOLOG)                           \
    X(GetProgramiv, GETPROGRAMIV) X(GetShaderInfoLog, GETSHADERINFOLOG)                           \
    X(GetShaderiv, GETSHADERIV) X(GetString, GETSTRING) X(GetStringi, GETSTRINGI)                 \
    X(GetUniformBlockIndex, GETUNIFORMBLOCKINDEX) X(GetUniformLocation, GETUNIFORMLOCATION)       \
    X(InvalidateFramebuffer, INVALIDATEFRAMEBUFFER)                                               \
    X(IsBuffer, ISBUFFER) X(IsEnabled, ISENABLED) X(IsFramebuffer, ISFRAMEBUFFER)                 \
    X(IsProgram, ISPROGRAM) X(IsSampler, ISSAMPLER) X(IsTexture, ISTEXTURE)                       \
    X(IsVertexArray, ISVERTEXARRAY) X(LinkProgram, LINKPROGRAM) X(MapBufferRange, MAPBUFFERRANGE) \
    X(MemoryBarrier, MEMORYBARRIER) X(ObjectLabel, OBJECTLABEL) X(PixelStorei, PIXELSTOREI)       \
    X(ReadBuffer, READBUFFER) X(ReadPixels, READPIXELS)                                           \
    X(RenderbufferStorageMultisample, RENDERBUFFERSTORAGEMULTISAMPLE)                             \
    X(SampleCoverage, SAMPLECOVERAGE) X(SampleMaski, SAMPLEMASKI)                                 \
    X(SamplerParameteri, SAMPLERPARAMETERI) X(Scissor, SCISSOR) X(ShaderSource, SHADERSOURCE)     \
    X(TexParameteri, TEXPARAMETERI) X(TexStorage2D, TEXSTORAGE2D) X(TexStorage3D, TEXSTORAGE3D)   \
    X(TexSubImage2D, TEXSUBIMAGE2D) X(TexSubImage3D, TEXSUBIMAGE3D) X(Uniform1f, UNIFORM1F)       \
    X(Uniform1i, UNIFORM1I) X(Uniform1ui, UNIFORM1UI) X(Uniform2f, UNIFORM2F)                     \
    X(Uniform2i, UNIFORM2I) X(Uniform3fv, UNIFORM3FV) X(Uniform3i, UNIFORM3I)                     \
    X(Uniform4i, UNIFORM4I) X(Uniform4uiv, UNIFORM4UIV)                                           \
    X(UniformBlockBinding, UNIFORMBLOCKBINDING)                                                   \
    X(UnmapBuffer, UNMAPBUFFER) X(UseProgram, USEPROGRAM)                                         \
    X(VertexAttribPointer, VERTEXATTRIBPOINTER) X(Viewport, VIEWPORT)
// clang-format on
