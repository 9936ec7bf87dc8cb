//! Accessors to vectors of numbers: strides, component types, normalisation, sparse values, every extent checked.
//!
//! Memory follows the bytes that are really there: an element count is compared with its view before anything is
//! allocated.

use std::borrow::Cow;

use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};

use super::buffers::Buffers;
use super::label;
use crate::error::{Error, Result};

/// Vectors of `N` floats, all finite. Integers become floats as they are, or over their range where normalised.
pub fn floats<const N: usize>(buffers: &Buffers<'_>, accessor: &Accessor<'_>) -> Result<Vec<[f32; N]>> {
    floats_at(buffers, accessor, None)
}

/// The same of the elements `picked` alone, each below the accessor's count; None: of all.
pub fn floats_at<const N: usize>(
    buffers: &Buffers<'_>,
    accessor: &Accessor<'_>,
    picked: Option<&[u32]>,
) -> Result<Vec<[f32; N]>> {
    within(accessor, || {
        if accessor.dimensions().multiplicity() != N || matches!(accessor.dimensions(), Dimensions::Mat2) {
            return Err(Error::request(format!(
                "holds {:?} values; {N} components each are needed",
                accessor.dimensions()
            )));
        }
        let elements = Elements::of(buffers, accessor)?;
        let values = match (accessor.data_type(), accessor.normalized()) {
            (DataType::F32, _) => elements.components(picked, f32::from_le_bytes),
            (DataType::U8, false) => elements.components(picked, |bytes| f32::from(u8::from_le_bytes(bytes))),
            (DataType::I8, false) => elements.components(picked, |bytes| f32::from(i8::from_le_bytes(bytes))),
            (DataType::U16, false) => elements.components(picked, |bytes| f32::from(u16::from_le_bytes(bytes))),
            (DataType::I16, false) => elements.components(picked, |bytes| f32::from(i16::from_le_bytes(bytes))),
            // glTF 2.0, section 3.11: the signed ranges are symmetric, so the lowest integer is clamped.
            (DataType::U8, true) => elements.components(picked, |bytes| f32::from(u8::from_le_bytes(bytes)) / 255.0),
            (DataType::I8, true) => {
                elements.components(picked, |bytes| (f32::from(i8::from_le_bytes(bytes)) / 127.0).max(-1.0))
            }
            (DataType::U16, true) => {
                elements.components(picked, |bytes| f32::from(u16::from_le_bytes(bytes)) / 65535.0)
            }
            (DataType::I16, true) => {
                elements.components(picked, |bytes| (f32::from(i16::from_le_bytes(bytes)) / 32767.0).max(-1.0))
            }
            (DataType::U32, _) => {
                return Err(Error::request("holds 32-bit integers; floats, bytes or shorts are needed"));
            }
        };
        match values.iter().position(|value: &[f32; N]| value.iter().any(|component| !component.is_finite())) {
            Some(place) => {
                let element = picked.map_or(place, |picked| picked[place] as usize);
                Err(Error::request(format!("element {element} is {:?}; all must be finite", values[place])))
            }
            None => Ok(values),
        }
    })
}

/// Vertex indices, each below `vertex_count`.
pub fn indices(buffers: &Buffers<'_>, accessor: &Accessor<'_>, vertex_count: usize) -> Result<Vec<u32>> {
    within(accessor, || {
        if accessor.dimensions() != Dimensions::Scalar {
            return Err(Error::request(format!("holds {:?} values; indices are scalars", accessor.dimensions())));
        }
        let elements = Elements::of(buffers, accessor)?;
        let values: Vec<[u32; 1]> = match accessor.data_type() {
            DataType::U8 => elements.components(None, |bytes| u32::from(u8::from_le_bytes(bytes))),
            DataType::U16 => elements.components(None, |bytes| u32::from(u16::from_le_bytes(bytes))),
            DataType::U32 => elements.components(None, u32::from_le_bytes),
            other => return Err(Error::request(format!("holds {other:?} components; indices are unsigned integers"))),
        };
        let values = values.into_flattened();
        match values.iter().position(|index| *index as usize >= vertex_count) {
            Some(element) => Err(Error::request(format!(
                "element {element} is vertex {}, but the primitive has {vertex_count} vertices",
                values[element]
            ))),
            None => Ok(values),
        }
    })
}

/// Indices of joints, four a vertex.
pub fn joints(buffers: &Buffers<'_>, accessor: &Accessor<'_>) -> Result<Vec<[u16; 4]>> {
    within(accessor, || {
        if accessor.dimensions() != Dimensions::Vec4 {
            return Err(Error::request(format!("holds {:?} values; joints are Vec4", accessor.dimensions())));
        }
        let elements = Elements::of(buffers, accessor)?;
        match accessor.data_type() {
            DataType::U8 => Ok(elements.components(None, |bytes| u16::from(u8::from_le_bytes(bytes)))),
            DataType::U16 => Ok(elements.components(None, u16::from_le_bytes)),
            other => {
                Err(Error::request(format!("holds {other:?} components; joints are unsigned bytes or unsigned shorts")))
            }
        }
    })
}

/// Errors: the file does not hold all elements of the accessor (exit code 2).
pub fn require_there(buffers: &Buffers<'_>, accessor: &Accessor<'_>) -> Result<()> {
    within(accessor, || Elements::of(buffers, accessor).map(|_| ()))
}

/// Whether each reading copies the whole accessor, because its elements do not lie in one view.
pub fn is_packed(accessor: &Accessor<'_>) -> bool {
    accessor.view().is_none() || accessor.sparse().is_some()
}

/// Errors: the accessor does not have one element for each of `vertex_count` vertices (exit code 2).
pub fn require_count(accessor: &Accessor<'_>, vertex_count: usize) -> Result<()> {
    if accessor.count() == vertex_count {
        return Ok(());
    }
    Err(Error::request(format!(
        "{} has {} elements, but POSITION has {vertex_count}",
        label::element("accessor", accessor.index(), accessor.name()),
        accessor.count()
    )))
}

fn within<T>(accessor: &Accessor<'_>, read: impl FnOnce() -> Result<T>) -> Result<T> {
    read().map_err(|error| error.within(label::element("accessor", accessor.index(), accessor.name())))
}

/// `count` elements of `size` bytes, one every `stride` bytes; the last may end before its stride does.
#[derive(Debug)]
struct Elements<'a> {
    bytes: Cow<'a, [u8]>,
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn of(buffers: &'a Buffers<'_>, accessor: &Accessor<'_>) -> Result<Self> {
        let (size, count) = (accessor.size(), accessor.count());
        let dense = match accessor.view() {
            Some(view) => Some(Self::in_view(buffers, &view, accessor.offset(), size, count)?),
            None => None,
        };
        match (dense, accessor.sparse()) {
            (Some(dense), None) => Ok(dense),
            (dense, sparse) => {
                let mut packed = match &dense {
                    Some(dense) => dense.iter().flatten().copied().collect(),
                    None => zeros(buffers, size, count)?,
                };
                if let Some(sparse) = sparse {
                    overlay(buffers, &sparse, size, count, &mut packed)
                        .map_err(|error| error.within("sparse values"))?;
                }
                Ok(Self { bytes: Cow::Owned(packed), stride: size, size, count })
            }
        }
    }

    /// Elements in a view from byte `offset` of it, at its stride or tightly packed.
    fn in_view(
        buffers: &'a Buffers<'_>,
        view: &gltf::buffer::View<'_>,
        offset: usize,
        size: usize,
        count: usize,
    ) -> Result<Self> {
        let bytes = buffers.view(view)?;
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(Error::request(format!(
                "elements of {size} bytes do not fit the stride of {stride} bytes of buffer view {}",
                view.index()
            )));
        }
        let bytes = span(bytes, offset, stride, size, count).ok_or_else(|| {
            Error::request(format!(
                "{count} elements of {size} bytes every {stride} bytes from byte {offset} reach beyond \
                 buffer view {}, which has {}",
                view.index(),
                bytes.len()
            ))
        })?;
        Ok(Self { bytes: Cow::Borrowed(bytes), stride, size, count })
    }

    fn at(&self, element: usize) -> &[u8] {
        &self.bytes[element * self.stride..][..self.size]
    }

    fn iter(&self) -> impl Iterator<Item = &[u8]> {
        (0..self.count).map(|element| self.at(element))
    }

    /// `N` components of `S` bytes of each element, or of those `picked`.
    fn components<const N: usize, const S: usize, T>(
        &self,
        picked: Option<&[u32]>,
        convert: impl Fn([u8; S]) -> T,
    ) -> Vec<[T; N]> {
        let element = |bytes: &[u8]| std::array::from_fn(|component| convert(bytes.as_chunks::<S>().0[component]));
        match picked {
            None => self.iter().map(element).collect(),
            Some(picked) => picked.iter().map(|place| element(self.at(*place as usize))).collect(),
        }
    }
}

/// The bytes from the first element's start to the last one's end; None where they reach beyond `bytes`.
fn span(bytes: &[u8], offset: usize, stride: usize, size: usize, count: usize) -> Option<&[u8]> {
    let Some(last) = count.checked_sub(1) else { return Some(&[]) };
    let length = last.checked_mul(stride)?.checked_add(size)?;
    bytes.get(offset..offset.checked_add(length)?)
}

/// An accessor without a view is zero before its sparse values; nothing in the file backs its count.
fn zeros(buffers: &Buffers<'_>, size: usize, count: usize) -> Result<Vec<u8>> {
    let file_bytes = buffers.file_bytes();
    let length = count.checked_mul(size).filter(|_| count <= file_bytes);
    length.map(|length| vec![0; length]).ok_or_else(|| {
        Error::request(format!(
            "{count} elements without a buffer view are more than a file with {file_bytes} bytes may ask for"
        ))
    })
}

fn overlay(
    buffers: &Buffers<'_>,
    sparse: &gltf::accessor::sparse::Sparse<'_>,
    size: usize,
    count: usize,
    packed: &mut [u8],
) -> Result<()> {
    let (places, values) = (sparse.indices(), sparse.values());
    let place_size = places.index_type().size();
    let places = Elements::in_view(buffers, &places.view(), places.offset(), place_size, sparse.count())?;
    let values = Elements::in_view(buffers, &values.view(), values.offset(), size, sparse.count())?;
    for (place, value) in places.iter().zip(values.iter()) {
        let mut word = [0; 4];
        word[..place_size].copy_from_slice(place);
        let place = u32::from_le_bytes(word) as usize;
        if place >= count {
            return Err(Error::request(format!("index {place} is not below the accessor's count of {count}")));
        }
        packed[place * size..][..size].copy_from_slice(value);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_ends_with_its_last_element_and_never_overflows() {
        let bytes = [0u8; 32];
        assert_eq!(span(&bytes, 0, 12, 8, 3).unwrap().len(), 32);
        assert_eq!(span(&bytes, 1, 12, 8, 3), None);
        assert_eq!(span(&bytes, 24, 8, 8, 1).unwrap().len(), 8);
        assert_eq!(span(&bytes, 99, 8, 8, 0).unwrap().len(), 0);
        assert_eq!(span(&bytes, 0, usize::MAX, 8, 2), None);
        assert_eq!(span(&bytes, 0, 8, 8, usize::MAX), None);
        assert_eq!(span(&bytes, usize::MAX, 8, 8, 1), None);
    }

    #[test]
    fn normalised_integers_cover_their_range() {
        let bytes = [0x80u8, 0x81, 0x7f, 0, 0xff, 0, 0, 0];
        let buffers = Buffers::of(&bytes);
        let read = |component_type: u32, normalized: bool| -> Vec<[f32; 1]> {
            let json = serde_json::json!({
                "asset": {"version": "2.0"},
                "buffers": [{"byteLength": 8}],
                "bufferViews": [{"buffer": 0, "byteLength": 8}],
                "accessors": [{"bufferView": 0, "componentType": component_type, "normalized": normalized,
                    "count": 4, "type": "SCALAR"}],
            });
            let document = super::super::document::parse(json.to_string().as_bytes()).unwrap().document;
            floats(&buffers, &document.accessors().next().unwrap()).unwrap()
        };
        assert_eq!(read(5120, true), [[-1.0], [-1.0], [1.0], [0.0]]);
        assert_eq!(read(5121, true), [[128.0 / 255.0], [129.0 / 255.0], [127.0 / 255.0], [0.0]]);
        assert_eq!(read(5120, false), [[-128.0], [-127.0], [127.0], [0.0]]);
        assert_eq!(read(5123, true)[2], [255.0 / 65535.0]);
        assert_eq!(read(5122, true)[2], [255.0 / 32767.0]);
    }
}
